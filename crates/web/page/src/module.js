// Requests to the module, which runs in a worker.

/** Returns the compiled module. All workers share it. */
export async function compiled(address) {
  const packed = await fetch(address);
  if (!packed.ok) throw new Error(`${address}: ${packed.status} ${packed.statusText}`);
  const unpacked = packed.body.pipeThrough(new DecompressionStream("gzip"));
  const headers = { "content-type": "application/wasm" };
  return WebAssembly.compileStreaming(new Response(unpacked, { headers }));
}

/**
 * A worker with a queue of requests.
 *
 * A reply is `{done}` or `{refused}` from the module, or `{superseded}` if a newer request of the
 * same kind replaced the request, `{stopped}` or `{crashed: text}`. `ms` is the time of the answer.
 */
export class Module {
  #waiting = [];
  #running = null;
  #worker = null;

  /** @param {Promise<WebAssembly.Module>} wasm */
  constructor(wasm, { onCrash, onBusy = () => {} }) {
    Object.assign(this, { wasm, onCrash, onBusy });
    this.#start();
  }

  /**
   * @param {object} request
   * @param {{kind?: string, urgent?: boolean, onFile?: Function, onProgress?: Function}} options
   * @returns {Promise<object>}
   */
  ask(request, { kind, urgent = false, ...listeners } = {}) {
    return new Promise((resolve) => {
      const old = kind ? this.#waiting.findIndex((own) => own.kind === kind) : -1;
      if (old >= 0) this.#waiting.splice(old, 1)[0].resolve({ superseded: true });
      this.#waiting.push({ request, kind, urgent, resolve, ...listeners });
      this.#next();
    });
  }

  /** Ends the worker and drops what waits for it. What it sent stays. */
  stop() {
    for (const own of this.#waiting.filter(({ kind }) => kind)) own.resolve({ stopped: true });
    this.#waiting = this.#waiting.filter(({ kind }) => !kind);
    this.#end({ stopped: true });
  }

  async #start() {
    const worker = new Worker("worker.js", { type: "module" });
    this.#worker = worker;
    worker.onmessage = ({ data }) => this.#take(data);
    worker.onerror = (event) => {
      event.preventDefault();
      this.#take({ crashed: event.message });
    };
    try {
      const wasm = await this.wasm;
      if (this.#worker !== worker) return;
      worker.postMessage({ wasm });
      this.isReady = true;
      this.#next();
    } catch (error) {
      this.onCrash(String(error), false);
    }
  }

  #end(reply) {
    const running = this.#running;
    this.#running = null;
    this.isReady = false;
    this.#worker.terminate();
    this.#start();
    this.onBusy(null);
    running?.resolve(reply);
  }

  #next() {
    if (this.#running || !this.isReady || !this.#waiting.length) return;
    const first = Math.max(this.#waiting.findIndex((own) => own.urgent), 0);
    [this.#running] = this.#waiting.splice(first, 1);
    this.#running.begun = performance.now();
    this.onBusy(this.#running.request);
    this.#worker.postMessage({ request: this.#running.request });
  }

  #take({ reply, file, bytes, progress, crashed }) {
    if (file) this.#running?.onFile?.(file, bytes);
    else if (progress) this.#running?.onProgress?.(progress);
    else if (crashed !== undefined) {
      this.onCrash(crashed, true);
      this.#end({ crashed });
    } else {
      const running = this.#running;
      this.#running = null;
      this.onBusy(null);
      running?.resolve({ ...reply, ms: performance.now() - running.begun });
      this.#next();
    }
  }
}
