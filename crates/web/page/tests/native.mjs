// Compares the answers of the module with those of the native program, for every example.
// usage: node native.mjs MODULE PROGRAM
import { execFileSync } from "node:child_process";
import { mkdtempSync, openSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { WASI } from "node:wasi";

const [module, program] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "pfaff-"));
process.on("exit", () => rmSync(folder, { recursive: true }));

// The module announces its progress on its standard output.
const progress = openSync(join(folder, "progress"), "w");
const wasi = new WASI({ version: "preview1", preopens: { out: folder }, stdout: progress });
const compiled = await WebAssembly.compile(readFileSync(module));
const instance = await WebAssembly.instantiate(compiled, wasi.getImportObject());
wasi.initialize(instance);

/** Sends a request to the module. */
function send(request) {
  const { memory, reserve, call, reply } = instance.exports;
  const bytes = new TextEncoder().encode(JSON.stringify(request));
  const at = reserve(bytes.length);
  new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
  const length = call();
  return JSON.parse(new TextDecoder().decode(new Uint8Array(memory.buffer, reply(), length)));
}

/** The document of the native program, or of its refusal. */
function native(question, scene, more) {
  try {
    const options = { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"], maxBuffer: 1 << 28 };
    return JSON.parse(execFileSync(program, [question, scene, "--json", ...more], options));
  } catch (failure) {
    return JSON.parse(failure.stdout);
  }
}

/**
 * Values that one rounding may change: the time of one of several equal extremes, the gap of a
 * singular value that is zero, and the configurations of a walk whose directions any basis of the
 * free motions may give. Memory and time depend on the machine.
 */
const LOOSE = /\.(peak|lowest|highest)(\.\w+)?\.time$|\.gap$|\.generic\.points\.|^\.(memory|wall_seconds)$/;

/** The first difference of two documents, as a path, or nothing. */
function difference(a, b, path = "") {
  if (typeof a === "number" && typeof b === "number") {
    const near = Math.abs(a - b) <= 1e-9 * Math.max(1, Math.abs(a), Math.abs(b));
    return near ? undefined : `${path}: ${a} and ${b}`;
  }
  if (a === null || b === null || typeof a !== "object" || typeof b !== "object") {
    return a === b ? undefined : `${path}: ${JSON.stringify(a)} and ${JSON.stringify(b)}`;
  }
  const keys = new Set([...Object.keys(a), ...Object.keys(b)]);
  for (const key of keys) {
    const inner = `${path}.${key}`;
    const found = LOOSE.test(inner) ? undefined : difference(a[key], b[key], inner);
    if (found) return found;
  }
  return undefined;
}

const { examples, questions } = send({ call: "about" }).done;
let compared = 0;
const wrong = [];
for (const { name, text } of examples) {
  const file = join(folder, `${name}.toml`);
  writeFileSync(file, text);
  const scenes = [{ name: file, text }];
  for (const question of ["check", "analyze", "plan", "simulate"]) {
    if (!questions.some((known) => known.name === question)) throw new Error(`no ${question}`);
    // Texts of small scenes name remedies without a request; documents do not.
    const options = question === "analyze" ? { remedies: true } : {};
    const { done, refused } = send({ call: "ask", question, scenes, options });
    const more = { analyze: ["--remedies"], simulate: ["--out", join(folder, name)] }[question];
    const theirs = native(question, file, more ?? []);
    const found = done
      ? difference(done.document, theirs)
      : difference(refused.error, theirs.error);
    if (found) wrong.push(`${name} ${question}${found}`);
    compared += 1;
  }
}

/** The text between two positions, in units of the editor or in bytes. */
const slice = (text, from, to) => text.slice(from, to);
const sliceBytes = (text, from, to) => Buffer.from(text).subarray(from, to).toString();

// Problems of wrong scenes, with the marked parts of their texts.
const refusals = new URL("../../../pfaff-cli/tests/wrong/", import.meta.url);
for (const name of readdirSync(refusals).filter((name) => name.endsWith(".toml"))) {
  const file = new URL(name, refusals).pathname;
  const text = readFileSync(file, "utf8");
  // An editor has no bytes that are not characters.
  if (text.includes("\ufffd")) continue;
  const scenes = [{ name: file, text }];
  const { done, refused } = send({ call: "ask", question: "check", scenes });
  const theirs = native("check", file, []);
  const ours = (refused?.problems ?? []).map(({ code, message, help, marks }) => ({
    code, message, help, marked: marks.map(({ from, to }) => slice(text, from, to)),
  }));
  const expected = (theirs.problems ?? []).map(({ code, message, help, primary, secondary }) => ({
    code, message, help,
    marked: [primary, ...secondary].map(({ span }) => sliceBytes(text, span.start, span.end)),
  }));
  const found = difference([refused?.error ?? null, ours], [theirs.error ?? null, expected]);
  if (found) wrong.push(`${name}${found}`);
  if (done && !theirs.ok && theirs.error) wrong.push(`${name} is answered`);
  compared += 1;
}
for (const line of wrong) console.error(line);
console.log(`${compared} answers compared, ${wrong.length} differ`);
process.exitCode = wrong.length ? 1 : 0;
