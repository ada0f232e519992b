// Puts the page together: the scene, its answers, and the tools.

import { Dragging } from "./drag.js";
import { afterPause, button, byId, download, make, withNames } from "./dom.js";
import { acceptDrops, Files, read } from "./files.js";
import { Frame } from "./frame.js";
import { allExamples, setUpGallery } from "./gallery.js";
import { compiled, Module } from "./module.js";
import { nameAt, placeOf } from "./names.js";
import { listProblems, withFixes } from "./problems.js";
import { fromAddress, toAddress } from "./share.js";
import { Tabs } from "./tabs.js";
import { Verdicts } from "./verdicts.js";

/** Pauses after typing before the scene is checked and before it is analysed (ms). */
const CHECK_PAUSE = 120;
const ANALYSE_PAUSE = 300;
/** A pointer that pauses for this time rests (ms). */
const REST = 150;
/** A request that takes longer shows a button to stop it (ms). */
const LONG = 700;
const STORED = "pfaff-scene";

const isEmbedded = new URLSearchParams(location.search).has("embed");
document.body.classList.toggle("embedded", isEmbedded);

const wasm = compiled("pfaff.wasm.gz");
const module = new Module(wasm, { onCrash, onBusy: showBusy });
/** Long runs have a worker of their own, so that the editor stays quick. */
let runner = null;

const files = new Files(byId("files"));
const verdicts = new Verdicts(byId("reactions"), { onSelect: selectEverywhere, onReplace: replaceJoints });
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
const tabs = new Tabs(byId("tabs"), [
  ["scene", "Scene", isEmbedded ? "tab" : "narrow"], ["picture", "Picture", isEmbedded ? "never" : "narrow"],
  ...["Verdicts", "Text", "Motion", "Files", "More", "Difference"].map((label) => [label.toLowerCase(), label, "tab"]),
], onTab);

/** The scene. `editor` is `null` until its script is loaded. */
const scene = { name: "", text: "", page: null, report: null };
let editor = null;
let second = null;

const source = () => ({ name: `${scene.name || "scene"}.toml`, text: scene.text });

// Messages

function say(text, ...actions) {
  const line = byId("message");
  const close = button("✕", () => { line.hidden = true; }, { className: "link", aria: { label: "Close message" } });
  line.replaceChildren(make("span", {}, ...[text].flat()), ...actions, close);
  line.hidden = false;
}

const listOf = (title, lines) => make("details", { open: lines.length < 6 },
  make("summary", { textContent: title }), make("ul", {}, ...lines.map((line) => make("li", {}, ...withNames(line)))));

function onCrash(text, isRestarted) {
  const first = isRestarted ? "The analysis program failed; the page made a new instance."
    : "The analysis program could not be loaded.";
  say([first, make("pre", { textContent: text })]);
}

let busyTimer;
function showBusy(request) {
  clearTimeout(busyTimer);
  byId("stop-analysis").hidden = true;
  if (request) busyTimer = setTimeout(() => { byId("stop-analysis").hidden = false; }, LONG);
}

const state = (text) => { byId("state").textContent = text; };

// Answers

/** The texts to which answers belong, by the elements of the answers. */
const answered = new Map();

/** Greys answers to another text. */
function greyStale() {
  for (const [id, text] of answered) byId(id).classList.toggle("stale", text !== scene.text);
}

/** Notes that an element shows the answer to a text. */
function showsAnswerTo(text, ...ids) {
  for (const id of ids) answered.set(id, text);
  greyStale();
}

async function check() {
  const { text } = scene;
  const { done } = await module.ask({ call: "diagnose", scene: source() }, { kind: "diagnose", urgent: true });
  if (done && text === scene.text) showProblems(done);
}

function showProblems(found) {
  const problems = found.map((problem) => withFixes(problem, scene.text));
  editor?.mark(problems);
  listProblems(byId("problems"), problems, {
    text: scene.text,
    onGo: (mark) => {
      tabs.isNarrow && tabs.show("scene");
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
    onProgress: ({ what, done, all }) => state(all ? `Analysing: ${what} ${done} of ${all}` : `Analysing: ${what}`),
  });
  if (text !== scene.text || reply.superseded) return;
  const { done, refused, stopped, ms } = reply;
  if (refused) {
    state("Not analysed");
    if (scene.isNew) clearAnswers();
    showProblems(refused.problems);
    if (!refused.problems.length) say(refused.error);
    byId("words").textContent = refused.error;
    showsAnswerTo(text, "words");
    return;
  }
  if (!done) {
    if (stopped) state("Stopped");
    return;
  }
  verdicts.show(done.document);
  byId("hint").classList.toggle("fits", done.document.mobility > 0);
  byId("words").textContent = done.text;
  showsAnswerTo(text, "reactions", "words");
  state(`Analysed in ${Math.round(ms)} ms`);
  if (!scene.isAnalysed) performance.mark("pfaff-verdict");
  Object.assign(scene, { isAnalysed: true, isNew: false });
}

/** Removes the answers to a former scene. */
function clearAnswers() {
  byId("reactions").replaceChildren();
  byId("words").textContent = "";
  byId("hint").classList.remove("fits");
  picture.clear();
  report.clear();
}

async function drawStart(text = scene.text) {
  const { done } = await module.ask({ call: "page", scene: { ...source(), text } }, { kind: "page", urgent: true });
  if (!done) return;
  scene.page = done;
  picture.show(done);
  if (!scene.report && tabs.current === "motion") showReport();
}

/** Shows the report of the run; before a run, the page of the start. */
function showReport() {
  const html = scene.report ?? scene.page;
  showsAnswerTo(scene.report ? scene.textOfReport : scene.text, "report");
  if (html && report.html !== html) report.show(html);
}

function refresh() {
  if (isOffered()) return;
  analyse();
  drawStart();
  check();
}

const checkSoon = afterPause(CHECK_PAUSE, () => !isOffered() && check());
const refreshSoon = afterPause(ANALYSE_PAUSE, refresh);
const store = afterPause(ANALYSE_PAUSE, () => {
  if (isOffered() || isEmbedded) return;
  try {
    localStorage.setItem(STORED, JSON.stringify({ name: scene.name, text: scene.text }));
  } catch {
    // A browser may forbid storage. The scene is then not kept.
  }
});

/** Removes a scene from the address, because it is no longer the scene of the page. */
function clearAddress() {
  if (location.hash && !isEmbedded) history.replaceState(null, "", location.pathname + location.search);
}

/** Links an embedded page to the page with all tools. */
const linkFullPage = afterPause(ANALYSE_PAUSE, async () => {
  byId("full").href = location.pathname + (await toAddress(scene) ?? "");
});

function onText(text) {
  scene.text = text;
  clearAddress();
  if (isEmbedded) linkFullPage();
  greyStale();
  checkSoon();
  refreshSoon();
  store();
}

/** Shows another scene. */
function open({ name, text }, { isFromAddress = false } = {}) {
  Object.assign(scene, { name, text, page: null, report: null, isNew: true });
  byId("name").value = name;
  editor?.open(text);
  files.clear();
  greyStale();
  byId("message").hidden = true;
  document.body.classList.toggle("offered", isFromAddress);
  selectEverywhere(null);
  if (isEmbedded) linkFullPage();
  if (!isFromAddress) {
    refresh();
    store();
    return;
  }
  clearAnswers();
  state("Not analysed");
  say("This scene comes from the address.", button("Analyse it", () => {
    document.body.classList.remove("offered");
    byId("message").hidden = true;
    clearAddress();
    refresh();
    store();
  }, { className: "main" }));
}

const isOffered = () => document.body.classList.contains("offered");

// Selection

function selectEverywhere(name, { isFromText = false } = {}) {
  verdicts.select(name);
  picture.select(name);
  report.select(name);
  const place = name && placeOf(scene.text, name);
  if (place && !isFromText) editor?.select(place);
}

function selectFromPicture({ joint, body }) {
  if (joint !== undefined) selectEverywhere(joint);
  else {
    const place = placeOf(scene.text, body);
    if (place) editor?.select(place);
  }
}

function onCursor(position) {
  const name = nameAt(scene.text, position);
  if (name && verdicts.has(name)) selectEverywhere(name, { isFromText: true });
}

// Edits

async function replaceJoints({ replace }) {
  const { done, refused } = await module.ask({ call: "retype", scene: source(), replace });
  if (!done) {
    if (refused) say(refused.error);
    return;
  }
  editor.replace(done);
  const joints = replace.map(({ joint }) => joint).join(", ");
  say(`Replaced in place: ${joints}.`, button("Undo", () => {
    editor.undo();
    byId("message").hidden = true;
  }));
}

const analyseAtRest = afterPause(REST, analyse);

const dragging = new Dragging({
  async place(body, pose) {
    scene.beforeDrag ??= scene.text;
    const { done, refused } = await module.ask({ call: "place", scene: source(), body, pose }, { urgent: true });
    if (refused) say(refused.error);
    if (!done || done === scene.text) return;
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
    } else {
      scene.text = beforeDrag;
      greyStale();
      refresh();
      say(["Joints and drives prevent a motion of ", make("code", { textContent: body }), "."]);
    }
  },
});

// Runs

/** Asks a question that takes long. Its files and rows come while it runs. */
async function run(question, options, scenes, { stop, state: line, progress }) {
  runner ??= new Module(wasm, { onCrash });
  if (runner.isRunning) {
    line.textContent = "Another run is not finished.";
    return {};
  }
  runner.isRunning = true;
  files.clear();
  stop.hidden = false;
  stop.onclick = () => runner.stop();
  line.textContent = "Running";
  const reply = await runner.ask({ call: "ask", question, options, scenes }, {
    onFile: (name, bytes) => files.add(name, bytes),
    onProgress: ({ what, done, all }) => {
      const rows = files.rows ? `, ${files.rows} rows` : "";
      line.textContent = all ? `${what}: ${Number(done.toPrecision(3))} of ${Number(all.toPrecision(3))}${rows}` : what;
      if (!progress) return;
      progress.hidden = false;
      if (all) progress.value = done / all;
    },
  });
  runner.isRunning = false;
  stop.hidden = true;
  if (progress) progress.hidden = true;
  const kept = files.rows ? ` Files contains ${files.rows} rows.` : "";
  if (reply.stopped) line.textContent = `Stopped.${kept}`;
  else if (reply.crashed !== undefined) line.textContent = `Failed.${kept}`;
  else if (reply.refused) line.textContent = "";
  else line.textContent = reply.done.complete ? `Done.${kept}` : `Incomplete.${kept}`;
  return reply;
}

async function simulate() {
  const { text } = scene;
  const { done, refused } = await run("simulate", {}, [source()], {
    stop: byId("stop-run"), state: byId("run-state"), progress: byId("progress"),
  });
  if (refused) {
    byId("run-state").textContent = refused.error;
    showProblems(refused.problems);
  }
  if (!done) return;
  const html = await files.text("report.html");
  if (html) Object.assign(scene, { report: html, textOfReport: text });
  else byId("run-state").textContent += " The scene requests no report.";
  showReport();
}

async function askQuestion() {
  let options;
  try {
    options = JSON.parse(byId("options").value || "{}");
  } catch (error) {
    byId("ask-state").textContent = `The options are not JSON: ${error.message}`;
    return;
  }
  const { text } = scene;
  const { done, refused } = await run(byId("question").value, options, [source()], {
    stop: byId("stop-ask"), state: byId("ask-state"),
  });
  byId("answer").textContent = done?.text ?? refused?.error ?? "";
  showsAnswerTo(text, "answer");
}

async function askDifference() {
  const { text } = scene;
  const scenes = [source(), { name: `${scene.name}-2.toml`, text: second.text }];
  const { done, refused } = await run("diff", {}, scenes, {
    stop: byId("stop-difference"), state: byId("difference-state"),
  });
  byId("difference-words").textContent = done?.text ?? refused?.error ?? "";
  showsAnswerTo(text, "difference-words");
}

// Tools

async function openFile(file) {
  if (!file) return;
  const opened = await read(file, module);
  if (opened.error) {
    say(opened.error);
    return;
  }
  open(opened);
  if (opened.format) {
    const title = `Imported from ${opened.format}: ${opened.remarks.length} remarks`;
    say(listOf(title, opened.remarks));
  }
}

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied.`);
  } catch {
    say([`${what}: `, make("code", { textContent: text })]);
  }
}

async function share() {
  const hash = await toAddress(scene);
  if (!hash) {
    say("The scene is too long for an address (8 kB). Save it as a file.");
    return;
  }
  history.replaceState(null, "", hash);
  await copy(location.href, "The address of the scene is");
}

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

function setTheme(theme) {
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  if (theme) document.documentElement.dataset.theme = theme;
  const isDark = (theme ?? (dark ? "dark" : "light")) === "dark";
  byId("theme").textContent = isDark ? "Light" : "Dark";
  byId("theme").onclick = () => setTheme(isDark ? "light" : "dark");
  picture.recolour();
  report.recolour();
}

function onTab(id) {
  if (id === "motion") showReport();
}

function setUpTools() {
  const on = (id, act) => byId(id).addEventListener("click", act);
  on("open", () => byId("file").click());
  byId("file").addEventListener("change", ({ target }) => {
    openFile(target.files[0]);
    target.value = "";
  });
  on("save", () => download(`${scene.name}.toml`, [scene.text]));
  on("share", share);
  on("compare", () => setCompare(byId("second").hidden));
  on("copy-command", () => copy(`pfaff analyze ${scene.name}.toml`, "Command"));
  on("copy-python", () => copy(`import pfaff\n\nprint(pfaff.Scene.from_file("${scene.name}.toml").analyze())\n`, "Python"));
  on("stop-analysis", () => module.stop());
  on("simulate", simulate);
  on("ask", askQuestion);
  on("ask-difference", askDifference);
  byId("bounds").addEventListener("change", analyse);
  byId("name").addEventListener("input", ({ target }) => {
    scene.name = target.value.replace(/[^\w.-]/g, "-");
    store();
  });
  acceptDrops(byId("drop"), openFile);
  setUpGallery((example) => open(example));
  setTheme();
}

async function listQuestions() {
  const { done } = await module.ask({ call: "about" });
  if (!done) return;
  const others = done.questions.filter(({ scenes, name }) => scenes.length === 1 && !["analyze", "simulate"].includes(name));
  byId("question").replaceChildren(...others.map(({ name }) => make("option", { value: name, textContent: name })));
}

/** The scene of the address, an example that the address names, the last scene, or the first example. */
async function firstScene() {
  try {
    const shared = await fromAddress(location.hash);
    if (shared) return [shared, { isFromAddress: true }];
  } catch {
    say("The scene in the address is damaged.");
  }
  const named = location.hash.match(/^#example=([\w-]+)$/)?.[1];
  const example = named && (await allExamples()).find(({ name }) => name === named);
  if (example) return [example];
  try {
    const stored = JSON.parse(localStorage.getItem(STORED));
    if (stored && !isEmbedded) return [stored];
  } catch {
    // Without a stored scene, the page begins with an example.
  }
  return [FIRST_EXAMPLE];
}

const editorScript = import("./editor.js");

async function start() {
  setUpTools();
  tabs.offer("difference", false);
  if (isEmbedded) ["motion", "files", "more"].forEach((id) => tabs.offer(id, false));
  tabs.show("verdicts");
  const first = await firstScene();
  open(...first);
  if (isEmbedded) {
    byId("full").hidden = false;
    byId("full").target = "_blank";
  }
  const { Editor } = await editorScript;
  editor = new Editor({ parent: byId("editor"), text: scene.text, label: "Scene", module, onChange: onText, onCursor });
  if (!isOffered()) check();
  listQuestions();
  addEventListener("hashchange", async () => {
    if (location.hash) open(...await firstScene());
  });
  const isSecure = location.protocol === "https:" || ["localhost", "127.0.0.1"].includes(location.hostname);
  if (isSecure && "serviceWorker" in navigator) navigator.serviceWorker.register("sw.js");
}

start();
