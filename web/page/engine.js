// The worker that computes, as the page sees it. It runs one request at a time; cancelling ends it, and a new one opens
// the same files.

export class Cancelled extends Error {}

// What the library says is wrong, and what to do next.
export class Failure extends Error {
  constructor(why, next) {
    super(why);
    this.next = next;
  }
}

export class Engine {
  constructor(module, source, heard) {
    this.module = module;
    this.address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    // Listeners: `progress`, `remark`, and `restarted`, after which nothing is open.
    this.heard = heard;
    this.files = [];
    this.last = 0;
    this.start();
  }

  start() {
    this.waiting = new Map();
    this.worker = new Worker(this.address);
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.worker.onerror = (event) => this.end(new Failure(event.message));
    this.worker.postMessage({ module: this.module });
    this.given = false;
  }

  hear(data) {
    if (data.stage !== undefined || data.share !== undefined) return this.heard.progress(data);
    if (data.remark !== undefined) return this.heard.remark(data.remark);
    const { resolve, reject } = this.waiting.get(data.id);
    this.waiting.delete(data.id);
    // After a trap its memory is in no known state.
    if (data.trapped) {
      reject(new Failure(data.failed, data.next));
      return this.end(new Cancelled());
    }
    if (data.failed !== undefined) return reject(new Failure(data.failed, data.next));
    return resolve(data.answer);
  }

  // Ends the worker, with what it was doing.
  end(why) {
    this.worker.terminate();
    for (const { reject } of this.waiting.values()) reject(why);
    this.start();
    this.heard.restarted();
  }

  cancel() {
    this.end(new Cancelled());
  }

  // Files by their path, which take the place of those before. They are read when something is opened.
  put(files) {
    this.files = files;
    this.given = false;
  }

  async open(request) {
    if (!this.given) await this.ask({ files: this.files });
    this.given = true;
    return this.call({ do: "open", ...request });
  }

  call(request) {
    return this.ask({ request });
  }

  ask(message) {
    const id = ++this.last;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, ...message });
    });
  }
}
