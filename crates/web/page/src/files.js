// Files of the last run, and files that the user opens.

import { button, download, make } from "./dom.js";

/** Files that grow while a run writes them. */
export class Files {
  #files = new Map();

  constructor(element) {
    this.element = element;
    this.show();
  }

  clear() {
    this.#files.clear();
    this.show();
  }

  /** Adds bytes to the end of a file. */
  add(name, bytes) {
    const file = this.#files.get(name) ?? { parts: [], size: 0, lines: 0 };
    this.#files.set(name, file);
    file.parts.push(bytes);
    file.size += bytes.length;
    if (name.endsWith(".csv")) for (const byte of bytes) file.lines += byte === 10;
    this.#isWaiting ??= requestAnimationFrame(() => {
      this.#isWaiting = undefined;
      this.show();
    });
  }

  #isWaiting;

  /** Returns the text of a file, or `null`. */
  async text(name) {
    const file = this.#files.get(name);
    return file ? new Blob(file.parts).text() : null;
  }

  /** Returns the number of rows of the tables; the first line of a table contains its columns. */
  get rows() {
    return Math.max(0, ...[...this.#files.values()].map(({ lines }) => lines - 1));
  }

  show() {
    const files = [...this.#files].sort(([a], [b]) => (a < b ? -1 : 1));
    if (!files.length) {
      const text = "A run writes its tables and its report here. Run “Simulate” or another question.";
      this.element.replaceChildren(make("p", { className: "grey", textContent: text }));
      return;
    }
    const save = (name) => download(name, this.#files.get(name).parts, "application/octet-stream");
    const head = ["File", "Rows", "Size", ""];
    this.element.replaceChildren(
      make("table", { className: "files" },
        make("thead", {}, make("tr", {}, ...head.map((textContent) => textContent
          ? make("th", { scope: "col", textContent }) : make("td")))),
        make("tbody", {}, ...files.map(([name, { size, lines }]) => make("tr", {},
          make("th", { scope: "row", textContent: name }),
          make("td", { className: "number", textContent: lines ? lines - 1 : "" }),
          make("td", { className: "number", textContent: `${(size / 1000).toFixed(1)} kB` }),
          make("td", {}, button("Download", () => save(name), { aria: { label: `Download ${name}` } })))))),
      button("Download all", () => files.forEach(([name]) => save(name))),
    );
  }
}

const isScene = (name) => /\.toml$/i.test(name);

/**
 * Reads a file: a scene, or a robot model that the module imports.
 * @returns {Promise<{name: string, text: string, remarks: string[]} | {error: string}>}
 */
export async function read(file, module) {
  const name = file.name.replace(/\.[^.]*$/, "");
  const text = await file.text();
  if (isScene(file.name)) return { name, text, remarks: [] };
  const { done, refused } = await module.ask({ call: "import", name: file.name, text });
  if (!done) return { error: refused?.error ?? "The import was interrupted." };
  return { name, text: done.text, format: done.format, remarks: remarksOf(done) };
}

/** The remarks of an import and the parts of the model that the scene does not contain. */
const remarksOf = ({ remarks, left_out: leftOut }) =>
  [...remarks, ...leftOut.map(([what, places]) => `Not imported: ${[what, places.join(", ")].filter(Boolean).join(": ")}`)];

/** Files that are dropped on the page. */
export function acceptDrops(shade, onFile) {
  const hasFile = (event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!hasFile(event)) return;
    event.preventDefault();
    shade.hidden = false;
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) shade.hidden = true;
  });
  addEventListener("drop", (event) => {
    shade.hidden = true;
    if (!hasFile(event)) return;
    event.preventDefault();
    event.stopPropagation();
    onFile(event.dataTransfer.files[0]);
  }, true);
}
