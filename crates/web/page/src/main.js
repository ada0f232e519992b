// Puts the page together: the editor, the answers, the selection, and edits in the picture.

import { Dragging } from "./drag.js";
import { afterPause, button, byId, make } from "./dom.js";
import { Frame } from "./frame.js";
import { setUpGallery } from "./gallery.js";
import { hush, say, sayCrash, state } from "./messages.js";
import { compiled, Module } from "./module.js";
import { nameAt, placeOf } from "./names.js";
import { listProblems, withFixes } from "./problems.js";
import { Runs } from "./runs.js";
import {
  cleanName, cleanText, clearAddress, firstScene, greyStale, isEmbedded, scene, showsAnswerTo, source,
  store,
} from "./scene.js";
import { toAddress } from "./share.js";
import { Tabs } from "./tabs.js";
import { setUpTools } from "./tools.js";
import { Verdicts } from "./verdicts.js";

/** Pauses after typing before the scene is checked and before it is analysed (ms). */
const CHECK_PAUSE = 120;
const ANALYSE_PAUSE = 300;
/** A pointer that pauses for this time rests (ms). */
const REST = 150;
/** A request that takes longer shows a button to stop it (ms). */
const LONG = 700;

const wasm = compiled("pfaff.wasm.gz");
const module = new Module(wasm, { onCrash: sayCrash, onBusy: showBusy });
const editorScript = import("./editor.js");
/** The editors. They are `null` until their script is loaded. */
let editor = null;
let second = null;

const verdicts = new Verdicts(byId("reactions"), { onSelect: select, onReplace: replaceJoints });
const picture = new Frame(byId("start"), {
  isPicture: true,
  on: {
    selected: selectFromPicture,
    grab: () => !isOffered() && dragging.grab(),
    drag: (detail) => dragging.drag(detail),
    drop: () => dragging.drop(),
  },
});
const report = new Frame(byId("report"), { at: "motion", on: { selected: selectFromPicture } });
const runs = new Runs(wasm, {
  second: () => second.text,
  onReport: showReport,
  onProblems: (problems) => showRefusal(problems),
});
const ALWAYS = ["Verdicts", "Text", "Motion", "Files", "More", "Difference"];
const tabs = new Tabs(byId("tabs"), [
  ["scene", "Scene", isEmbedded ? "tab" : "narrow"],
  ["picture", "Picture", isEmbedded ? "never" : "narrow"],
  ...ALWAYS.map((label) => [label.toLowerCase(), label, "tab"]),
], (id) => id === "motion" && showReport());

/** Whether the page shows a scene of the address that the user has not accepted. */
const isOffered = () => document.body.classList.contains("offered");

let busyTimer;
function showBusy(request) {
  clearTimeout(busyTimer);
  byId("stop-analysis").hidden = true;
  if (request) busyTimer = setTimeout(() => { byId("stop-analysis").hidden = false; }, LONG);
}

// Answers

async function check() {
  const { text } = scene;
  const request = { call: "diagnose", scene: source() };
  const { done } = await module.ask(request, { kind: "diagnose", urgent: true });
  if (!done || text !== scene.text) return;
  // The analysis finds problems that a reading does not find.
  const isWrong = done.some(({ severity }) => severity === "error");
  const more = !isWrong && scene.refusal?.text === text ? scene.refusal.problems : [];
  showProblems([...done, ...more]);
}

/** Shows problems that an answer found. They stay until the text changes. */
function showRefusal(problems, text = scene.text) {
  scene.refusal = { text, problems };
  if (text === scene.text) showProblems(problems);
}

function showProblems(found) {
  const problems = found.map((problem) => withFixes(problem, scene.text));
  editor?.mark(problems);
  listProblems(byId("problems"), problems, {
    text: scene.text,
    onGo: (mark) => {
      if (tabs.isNarrow) tabs.show("scene");
      editor?.select(mark);
      editor?.focus();
    },
    onFix: (fix) => editor?.change(fix, fix.insert),
    onExplain: async (code, item) => {
      const { done } = await module.ask({ call: "explain", code });
      if (done && !item.querySelector("pre")) item.append(make("pre", { textContent: done }));
    },
  });
}

async function analyse() {
  const { text } = scene;
  const options = byId("bounds").checked ? { elastic: { bounds: true } } : {};
  const request = { call: "ask", question: "analyze", options, scenes: [source()] };
  const reply = await module.ask(request, {
    kind: "analyze",
    // The first verdict comes before the first picture. Later, the picture follows the pointer.
    urgent: !scene.isAnalysed,
    onProgress: ({ what, done, all }) =>
      state(all ? `Analysing: ${what} ${done} of ${all}` : `Analysing: ${what}`),
  });
  if (text !== scene.text || reply.superseded) return;
  const { done, refused, stopped, crashed, ms } = reply;
  if (stopped) state("Stopped");
  if (crashed !== undefined) state("Failed");
  if (!done && scene.isNew) clearAnswers();
  if (refused) {
    state("Not analysed");
    showRefusal(refused.problems, text);
    if (!refused.problems.length) say(refused.error);
    byId("words").textContent = refused.error;
    showsAnswerTo(text, "words");
  }
  if (!done) return;
  scene.refusal = null;
  verdicts.show(done.document);
  byId("hint").classList.toggle("fits", done.document.mobility > 0);
  byId("words").textContent = done.text;
  showsAnswerTo(text, "reactions", "words");
  state(`Analysed in ${Math.round(ms)} ms`);
  if (!scene.isAnalysed) performance.mark("pfaff-verdict");
  Object.assign(scene, { isAnalysed: true, isNew: false });
}

async function drawStart() {
  const { text } = scene;
  const request = { call: "page", scene: source(), dragged: scene.beforeDrag !== undefined };
  const { done } = await module.ask(request, { kind: "page", urgent: true });
  if (!done || text !== scene.text) return;
  Object.assign(scene, { page: done, textOfPage: text });
  picture.show(done);
  showsAnswerTo(text, "start");
  if (!scene.report && tabs.current === "motion") showReport();
}

/** Shows the report of the run; before a run, the page of the start. */
function showReport() {
  const html = scene.report ?? scene.page;
  showsAnswerTo(scene.report ? scene.textOfReport : scene.textOfPage, "report");
  if (html && report.html !== html) report.show(html);
}

/** Removes the answers to a former scene. */
function clearAnswers() {
  showProblems([]);
  byId("reactions").replaceChildren();
  byId("words").textContent = "";
  byId("hint").classList.remove("fits");
  picture.clear();
  report.clear();
}

function refresh() {
  if (isOffered()) return;
  analyse();
  drawStart();
  check();
}

const checkSoon = afterPause(CHECK_PAUSE, () => !isOffered() && check());
const refreshSoon = afterPause(ANALYSE_PAUSE, refresh);
const storeSoon = afterPause(ANALYSE_PAUSE, () => !isOffered() && store());

/** Links an embedded page to the page with all tools. */
const linkFullPage = afterPause(ANALYSE_PAUSE, async () => {
  byId("full").href = location.pathname + (await toAddress(scene) ?? "");
});

function onText(text) {
  scene.text = text;
  if (replaced !== null && text !== replaced) {
    replaced = null;
    hush();
  }
  // Who types during a drag ends it.
  scene.beforeDrag = undefined;
  scene.isEdited = true;
  if (!isOffered()) {
    clearAddress();
    state("Waiting");
  }
  if (isEmbedded) linkFullPage();
  greyStale();
  checkSoon();
  refreshSoon();
  storeSoon();
}

/**
 * Shows another scene. A scene of the address is analysed when the user accepts it. An edited scene
 * can be brought back.
 */
function open(next, { isFromAddress = false, keepsAddress = false } = {}) {
  const former = scene.isEdited ? { name: scene.name, text: scene.text } : null;
  const [name, text] = [cleanName(next.name), cleanText(next.text)];
  Object.assign(scene, {
    name, text, page: null, report: null, refusal: null, beforeDrag: undefined, isNew: true, isEdited: false,
  });
  byId("name").value = name;
  editor?.open(text);
  runs.abandon();
  if (!keepsAddress) clearAddress();
  greyStale();
  hush();
  if (former) say(`Opened ${name}.`, button(`Back to ${former.name}`, () => open(former)));
  document.body.classList.toggle("offered", isFromAddress);
  byId("offer").hidden = !isFromAddress;
  select(null);
  if (isEmbedded) linkFullPage();
  if (!isFromAddress) {
    accept();
    return;
  }
  clearAnswers();
  state("Not analysed");
}

/** Analyses the scene, which may come from an address. */
function accept() {
  document.body.classList.remove("offered");
  byId("offer").hidden = true;
  state("Waiting");
  refresh();
  storeSoon();
}

// Selection

/** Selects a joint or drive in the table, in the picture and in the text; `null` selects nothing. */
function select(name, { isFromText = false } = {}) {
  verdicts.select(name);
  picture.select(name);
  report.select(name);
  const place = name && placeOf(scene.text, name);
  if (place && !isFromText) editor?.select(place);
}

function selectFromPicture({ joint, body }) {
  if (joint !== undefined) {
    select(joint);
    return;
  }
  const place = placeOf(scene.text, body);
  if (place) editor?.select(place);
}

function onCursor(position) {
  const name = nameAt(scene.text, position);
  if (name && verdicts.has(name)) select(name, { isFromText: true });
}

// Edits

/** The text after a replacement whose message offers to undo it. */
let replaced = null;

async function replaceJoints({ replace }) {
  const { done, refused } = await module.ask({ call: "retype", scene: source(), replace });
  if (refused) say(refused.error);
  if (!done) return;
  replaced = done;
  editor.replace(done);
  const undo = button("Undo", () => editor.undo());
  say(`Replaced in place: ${replace.map(({ joint }) => joint).join(", ")}.`, undo);
}

const analyseAtRest = afterPause(REST, analyse);

const dragging = new Dragging({
  async place(body, pose) {
    const { text } = scene;
    scene.beforeDrag ??= text;
    const request = { call: "place", scene: source(), body, pose };
    const { done, refused } = await module.ask(request, { urgent: true });
    // The user has opened another scene or has typed.
    if (text !== scene.text || scene.beforeDrag === undefined) return;
    if (refused) say(refused.error);
    if (!done || done === text) return;
    scene.text = done;
    editor?.preview(done);
    greyStale();
    // The picture follows the pointer with its verdicts; the table follows when the pointer rests.
    await drawStart();
    analyseAtRest();
  },
  drop({ body, hasMoved }) {
    const { beforeDrag, text } = scene;
    scene.beforeDrag = undefined;
    if (beforeDrag === undefined || beforeDrag === text) return;
    editor?.preview(beforeDrag);
    if (hasMoved) {
      byId("hint").hidden = true;
      editor?.replace(text);
      return;
    }
    scene.text = beforeDrag;
    greyStale();
    refresh();
    say(["Joints and drives prevent a motion of ", make("code", { textContent: body }), "."]);
  },
});

/** Shows or hides a second scene, which begins as a copy. */
async function setCompare(isOn) {
  byId("compare").setAttribute("aria-pressed", isOn);
  byId("second").hidden = !isOn;
  tabs.offer("difference", isOn);
  if (!isOn) return;
  const { Editor } = await editorScript;
  second ??= new Editor({
    parent: byId("second"), text: scene.text, label: "Second scene", module,
    onChange: () => showsAnswerTo(null, "difference-words"),
  });
  tabs.show("difference");
}

async function start() {
  document.body.classList.toggle("embedded", isEmbedded);
  byId("full").hidden = !isEmbedded;
  tabs.offer("difference", false);
  if (isEmbedded) ["motion", "files", "more"].forEach((id) => tabs.offer(id, false));
  tabs.show("verdicts");
  const onTheme = () => [picture, report].forEach((frame) => frame.recolour());
  setUpTools({ module, open, onTheme });
  setUpGallery((example) => open(example));
  byId("stop-analysis").addEventListener("click", () => module.stop());
  byId("compare").addEventListener("click", () => setCompare(byId("second").hidden));
  byId("bounds").addEventListener("change", () => !isOffered() && analyse());
  byId("accept").addEventListener("click", () => {
    clearAddress();
    accept();
  });

  const openFirst = async () => {
    const { first, isShared, isDamaged } = await firstScene();
    open(first, { isFromAddress: isShared, keepsAddress: true });
    if (isDamaged) say("The scene in the address is damaged, or is not known.");
  };
  await openFirst();
  addEventListener("hashchange", () => location.hash && openFirst());
  const { Editor } = await editorScript;
  editor = new Editor({
    parent: byId("editor"), text: scene.text, label: "Scene", module, onChange: onText, onCursor,
  });
  if (!isOffered()) check();
  const { done: about } = await module.ask({ call: "about" });
  if (about) runs.offer(about.questions);
  const isSecure = location.protocol === "https:" || ["localhost", "127.0.0.1"].includes(location.hostname);
  if (isSecure && "serviceWorker" in navigator) navigator.serviceWorker.register("sw.js");
}

start();
