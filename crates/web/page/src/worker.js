// One instance of the module. Files that the module writes stay in memory. Rows of tables are sent
// while the module computes.

import {
  ConsoleStdout, Directory, File, OpenFile, PreopenDirectory, WASI,
} from "@bjorn3/browser_wasi_shim";

const NEWLINE = 10;
/** The end of the name of a file until it is complete. */
const PART = /\.part$/;
/** The least room of a file (bytes). */
const ROOM = 1 << 16;

/** A file whose room doubles, so that many small writes take linear time. */
class GrowingFile extends File {
  constructor(name) {
    super([]);
    Object.assign(this, { name: name.replace(PART, ""), sent: 0 });
  }

  path_open(oflags, rights, flags) {
    const opened = super.path_open(oflags, rights, flags);
    if (opened.fd_obj) opened.fd_obj = Object.setPrototypeOf(opened.fd_obj, OpenGrowingFile.prototype);
    return opened;
  }

  put(bytes, at) {
    const end = at + bytes.length;
    if (end > this.data.buffer.byteLength) {
      const room = new Uint8Array(Math.max(2 * end, ROOM));
      room.set(this.data);
      this.data = room.subarray(0, this.data.length);
    }
    if (end > this.data.length) this.data = new Uint8Array(this.data.buffer, 0, end);
    this.data.set(bytes, at);
  }

  /** Sends the whole rows that were not sent yet, or all that is left. */
  send(all = false) {
    const end = all ? this.data.length : this.data.lastIndexOf(NEWLINE) + 1;
    if (!all && end <= this.sent) return;
    const bytes = this.data.slice(this.sent, end);
    this.sent = end;
    postMessage({ file: this.name, bytes }, [bytes.buffer]);
  }
}

class OpenGrowingFile extends OpenFile {
  fd_write(bytes) {
    this.file.put(bytes, Number(this.file_pos));
    this.file_pos += BigInt(bytes.length);
    if (this.file.name.endsWith(".csv")) this.file.send();
    return { ret: 0, nwritten: bytes.length };
  }
}

/** The directory of an answer. */
class Out extends Directory {
  create_entry_for_path(path, isDirectory) {
    const created = super.create_entry_for_path(path, isDirectory);
    if (created.entry && !isDirectory && this.contents.has(path)) {
      created.entry = new GrowingFile(path);
      this.contents.set(path, created.entry);
    }
    return created;
  }
}

const out = new Out(new Map());
const preopened = new PreopenDirectory("out", new Map());
preopened.dir = out;
let errors = "";
const decoder = new TextDecoder();
const wasi = new WASI([], [], [
  new ConsoleStdout(() => {}),
  ConsoleStdout.lineBuffered((line) => postMessage({ progress: JSON.parse(line) })),
  new ConsoleStdout((bytes) => { errors += decoder.decode(bytes, { stream: true }); }),
  preopened,
], { debug: false });

/** The promise of the instance. */
let instance;

async function instantiated(wasm) {
  const made = await WebAssembly.instantiate(wasm, { wasi_snapshot_preview1: wasi.wasiImport });
  wasi.initialize(made);
  return made;
}

function answer({ memory, reserve, call, reply }, request) {
  const bytes = new TextEncoder().encode(JSON.stringify(request));
  // The memory may grow, and its buffer is then another one.
  const at = reserve(bytes.length);
  new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
  const length = call();
  return JSON.parse(decoder.decode(new Uint8Array(memory.buffer, reply(), length)));
}

onmessage = async ({ data: { wasm, request } }) => {
  try {
    if (wasm) instance = instantiated(wasm);
    const { exports } = await instance;
    if (!request) return;
    out.contents.clear();
    const reply = answer(exports, request);
    for (const file of out.contents.values()) file.send?.(true);
    postMessage({ reply });
  } catch (error) {
    postMessage({ crashed: `${errors}${error}` });
  }
};
