// Questions that take long: runs, comparisons and others. They have a worker of their own, so that
// the editor stays quick. Their files and rows come while they run.

import { byId, make } from "./dom.js";
import { Files } from "./files.js";
import { sayCrash } from "./messages.js";
import { Module } from "./module.js";
import { scene, showsAnswerTo, source } from "./scene.js";

/** Questions with views of their own. */
const SHOWN_ELSEWHERE = ["analyze", "simulate"];

const rounded = (x) => Number(x.toPrecision(3));

export class Runs {
  #runner = null;
  #isRunning = false;

  /**
   * @param {Promise<WebAssembly.Module>} wasm
   * @param {object} actions
   * @param {() => string} actions.second returns the text of the second scene
   * @param {() => void} actions.onReport called after a run with a report
   * @param {(problems: object[]) => void} actions.onProblems
   */
  constructor(wasm, actions) {
    Object.assign(this, { wasm, actions });
    this.files = new Files(byId("files"));
    byId("simulate").addEventListener("click", () => this.simulate());
    byId("ask").addEventListener("click", () => this.askOther());
    byId("ask-difference").addEventListener("click", () => this.askDifference());
  }

  /** Offers the questions about one scene that have no view of their own. */
  offer(questions) {
    const others = questions.filter(({ name, scenes }) =>
      scenes.length === 1 && !SHOWN_ELSEWHERE.includes(name));
    const options = others.map(({ name }) => make("option", { value: name, textContent: name }));
    byId("question").replaceChildren(...options);
  }

  /** Ends a run whose scene is no longer shown, and removes its files. */
  abandon() {
    if (this.#isRunning) this.#runner.stop();
    this.files.clear();
  }

  async simulate() {
    const { text } = scene;
    const { done, refused } = await this.#run("simulate", {}, [source()], "run");
    if (refused) {
      byId("run-state").textContent = refused.error;
      this.actions.onProblems(refused.problems);
    }
    if (!done) return;
    const report = await this.files.text("report.html");
    if (report) Object.assign(scene, { report, textOfReport: text });
    else byId("run-state").textContent += " The scene requests no report.";
    this.actions.onReport();
  }

  async askOther() {
    let options;
    try {
      options = JSON.parse(byId("options").value || "{}");
    } catch (error) {
      byId("ask-state").textContent = `The options are not JSON: ${error.message}`;
      return;
    }
    await this.#answer(byId("question").value, options, [source()], "ask", "answer");
  }

  async askDifference() {
    const other = { name: `${scene.name}-2.toml`, text: this.actions.second() };
    await this.#answer("diff", {}, [source(), other], "difference", "difference-words");
    if (this.actions.second() !== other.text) showsAnswerTo(null, "difference-words");
  }

  async #answer(question, options, scenes, controls, place) {
    const { text } = scene;
    const { done, refused } = await this.#run(question, options, scenes, controls);
    byId(place).textContent = done?.text ?? refused?.error ?? "";
    showsAnswerTo(text, place);
  }

  /** Asks a question; its view has the elements `stop-…` and `…-state`. */
  async #run(question, options, scenes, controls) {
    const [stop, line] = [byId(`stop-${controls}`), byId(`${controls}-state`)];
    if (this.#isRunning) {
      line.textContent = "Another run is not finished.";
      return {};
    }
    this.#runner ??= new Module(this.wasm, { onCrash: sayCrash });
    this.#isRunning = true;
    this.files.clear();
    stop.hidden = false;
    stop.onclick = () => this.#runner.stop();
    line.textContent = "Running";
    const reply = await this.#runner.ask({ call: "ask", question, options, scenes }, {
      onFile: (name, bytes) => this.files.add(name, bytes),
      onProgress: (progress) => this.#show(progress, line, controls),
    });
    this.#isRunning = false;
    stop.hidden = true;
    byId("progress").hidden = true;
    const rows = this.files.rows ? ` The tab Files has ${this.files.rows} rows.` : "";
    if (reply.stopped) line.textContent = `Stopped.${rows}`;
    else if (reply.crashed !== undefined) line.textContent = `Failed.${rows}`;
    else if (reply.refused) line.textContent = "";
    else line.textContent = reply.done.complete ? `Done.${rows}` : `Incomplete.${rows}`;
    return reply;
  }

  #show({ what, done, all }, line, controls) {
    const rows = this.files.rows ? `, ${this.files.rows} rows` : "";
    line.textContent = all ? `${what}: ${rounded(done)} of ${rounded(all)}${rows}` : what;
    if (controls !== "run" || !all) return;
    byId("progress").hidden = false;
    byId("progress").value = done / all;
  }
}
