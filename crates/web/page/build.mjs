// Writes the static page: node build.mjs OUT WASM

import { createHash } from "node:crypto";
import { existsSync, mkdirSync, mkdtempSync, openSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { devNull, tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { WASI } from "node:wasi";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const HERE = dirname(fileURLToPath(import.meta.url));
/** The largest editor (bytes, gzip -9). */
const EDITOR_MOST = 180_000;

const [folder, wasmFile] = process.argv.slice(2);
if (!wasmFile) throw new Error("usage: node build.mjs OUT WASM");
const out = resolve(folder);
mkdirSync(out, { recursive: true });

/** Starts the module and returns a function that answers requests. */
async function started(wasm, directory) {
  const wasi = new WASI({ version: "preview1", preopens: { out: directory }, stdout: openSync(devNull, "w") });
  const instance = await WebAssembly.instantiate(await WebAssembly.compile(wasm), wasi.getImportObject());
  wasi.initialize(instance);
  const { memory, reserve, call, reply } = instance.exports;
  return (request) => {
    const bytes = new TextEncoder().encode(JSON.stringify(request));
    const at = reserve(bytes.length);
    new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
    const length = call();
    const { done, refused } = JSON.parse(new TextDecoder().decode(new Uint8Array(memory.buffer, reply(), length)));
    if (refused) throw new Error(`${request.call}: ${refused.error}`);
    return done;
  };
}

/** The sources of the policy that permit the inline scripts of a page. Data are not scripts. */
function hashesOf(html) {
  const scripts = html.matchAll(/<script(?![^>]*application\/json)[^>]*>([\s\S]*?)<\/script>/g);
  return Array.from(scripts, ([, text]) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`);
}

/** Returns the hashes of the scripts of the two kinds of pages. */
function scriptHashes(ask, { name, text }, directory) {
  const scene = { name: `${name}.toml`, text };
  const pages = [ask({ call: "page", scene })];
  ask({ call: "ask", question: "simulate", scenes: [scene] });
  pages.push(readFileSync(join(directory, "report.html"), "utf8"));
  return [...new Set(pages.flatMap(hashesOf))];
}

/** Looks of thumbnails: no texts, larger symbols. */
const THUMBNAIL = `text { display: none; } .mark, .thin, .groove, .foot { transform: scale(1.8); }
.site, .rod { stroke-width: 3; } .rod { stroke-width: 5; }`;

/** Returns a picture without its title, scale and legend. */
function thumbnail(picture) {
  const end = picture.indexOf('<g class="scale">');
  const [width, height] = picture.match(/viewBox="0 0 (\S+) (\S+)"/).slice(1).map(Number);
  const bottom = end < 0 ? height : Number(picture.slice(end).match(/M\S+ (\S+?)v/)?.[1] ?? height);
  return `${end < 0 ? picture.replace("</svg>", "") : picture.slice(0, end)}</svg>`
    .replace(/<rect width="[\d.]+" height="[\d.]+" fill="#ffffff"\/>/, "")
    .replace(/ width="[^"]*" height="[^"]*" viewBox="[^"]*"/, ` viewBox="0 30 ${width} ${bottom - 30}"`)
    .replace("</style>", `${THUMBNAIL}</style>`);
}

/** The licences of the packages in the bundles, with their texts. */
function licences(metafiles) {
  const files = metafiles.flatMap(({ inputs }) => Object.keys(inputs));
  const names = new Set(files.map((file) => file.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1]).filter(Boolean));
  return [...names].sort().map((name) => {
    const folder = join(HERE, "node_modules", name);
    const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const texts = readdirSync(folder).filter((file) => /^licen[cs]e/i.test(file)).sort();
    const text = texts.map((file) => readFileSync(join(folder, file), "utf8").trim()).join("\n\n");
    return `${name} ${version} (${license})\n\n${text}\n`;
  }).join(`\n${"-".repeat(72)}\n\n`);
}

const wasm = readFileSync(wasmFile);
const directory = mkdtempSync(join(tmpdir(), "pfaff-page-"));
const ask = await started(wasm, directory);
const { examples, version } = ask({ call: "about" });
const pictured = examples.map(({ name, summary, text }) => ({
  name, summary, text, picture: thumbnail(ask({ call: "picture", scene: { name: `${name}.toml`, text } })),
}));
const hashes = scriptHashes(ask, examples[0], directory);
rmSync(directory, { recursive: true });

const [{ name, text }] = examples;
const common = {
  bundle: true, minify: true, format: "esm", target: "es2022", charset: "utf8", metafile: true, absWorkingDir: HERE,
  legalComments: "none", logLevel: "warning",
};
const bundle = (entry, file, options = {}) =>
  build({ ...common, entryPoints: [`src/${entry}.js`], outfile: join(out, file), ...options });
const bundles = await Promise.all([
  bundle("main", "page.js", { external: ["./editor.js"], define: { FIRST_EXAMPLE: JSON.stringify({ name, text }) } }),
  bundle("editor", "editor.js"),
  bundle("worker", "worker.js"),
]);

const policy = [
  "default-src 'none'", `script-src 'self' 'wasm-unsafe-eval' ${hashes.join(" ")}`, "style-src 'self' 'unsafe-inline'",
  "img-src data: blob:", "worker-src 'self'", "connect-src 'self'", "base-uri 'none'", "form-action 'none'",
].join("; ");
const write = (file, content) => writeFileSync(join(out, file), content);
write("index.html", readFileSync(join(HERE, "index.html"), "utf8").replace("{{policy}}", policy)
  .replace("{{book}}", existsSync(join(out, "book/index.html")) ? '<a class="full" href="book/index.html">Book</a>' : ""));
write("style.css", readFileSync(join(HERE, "style.css"), "utf8"));
write("pfaff.wasm.gz", gzipSync(wasm, { level: 9 }));
write("examples.json", JSON.stringify(pictured));
write("licences.txt", licences(bundles.map(({ metafile }) => metafile)));

const files = ["index.html", "page.js", "editor.js", "worker.js", "style.css", "pfaff.wasm.gz", "examples.json", "licences.txt"];
const contents = files.map((file) => readFileSync(join(out, file)));
const digest = createHash("sha256");
contents.forEach((content) => digest.update(content));
await bundle("sw", "sw.js", {
  define: { VERSION: JSON.stringify(digest.digest("hex").slice(0, 16)), FILES: JSON.stringify(["./", ...files]) },
});

const sizes = files.map((file, k) =>
  [file, contents[k].length, file.endsWith(".gz") ? contents[k].length : gzipSync(contents[k], { level: 9 }).length]);
for (const [file, size, packed] of sizes) console.log(file.padEnd(16), String(size).padStart(9), String(packed).padStart(9));
console.log("total".padEnd(26), String(sizes.reduce((sum, [, , packed]) => sum + packed, 0)).padStart(9), `version ${version}`);
const editor = sizes.find(([file]) => file === "editor.js")[2];
if (editor > EDITOR_MOST) throw new Error(`editor.js has ${editor} bytes after gzip, more than ${EDITOR_MOST}`);
