// Runs the library: a WASI program whose files are those that the user chose, in memory.

import { ConsoleStdout, Directory, File, OpenFile, PreopenDirectory, WASI } from "@bjorn3/browser_wasi_shim";

let exports = null;
// Why it could not be started.
let unloaded = null;
// Messages wait for the module and for their files.
let ready = Promise.resolve();
const root = new PreopenDirectory("/", new Map());
// The last lines on standard error say why a program ends.
let complaints = [];

function complain(line) {
  complaints.push(line);
  if (!/^(thread '|note:|cannot be decoded: |$)/.test(line)) postMessage({ remark: line });
}

async function load(module) {
  const output = ConsoleStdout.lineBuffered(complain);
  const wasi = new WASI([], [], [new OpenFile(new File([])), output, output, root], { debug: false });
  const page = {
    stage: (at, length) => postMessage({ stage: text(at, length) }),
    progress: (share) => postMessage({ share }),
  };
  const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasi.wasiImport, page });
  wasi.initialize(instance);
  exports = instance.exports;
  exports.begin();
}

async function put(files) {
  root.dir.contents.clear();
  for (const { path, file } of files) {
    const folders = path.split("/");
    const name = folders.pop();
    let folder = root.dir;
    for (const part of folders) {
      if (!folder.contents.has(part)) folder.contents.set(part, new Directory(new Map()));
      folder = folder.contents.get(part);
    }
    folder.contents.set(name, new File(await file.arrayBuffer(), { readonly: true }));
  }
}

const text = (at, length) => new TextDecoder().decode(new Uint8Array(exports.memory.buffer, at, length));

function call(request) {
  const bytes = new TextEncoder().encode(JSON.stringify(request));
  const at = exports.reserve(bytes.length) >>> 0;
  new Uint8Array(exports.memory.buffer, at, bytes.length).set(bytes);
  const place = exports.call(at, bytes.length) >>> 0;
  const [start, length] = new Uint32Array(exports.memory.buffer, place, 2);
  const { arrays, ...answer } = JSON.parse(text(start, length));
  // Copies, as the next call frees these.
  for (const [name, array] of Object.entries(arrays)) {
    answer[name] = new globalThis[array.kind](exports.memory.buffer, array.at, array.length).slice();
  }
  return answer;
}

onmessage = ({ data: { id, module, files, request } }) => {
  ready = ready.then(async () => {
    if (module) return load(module).catch((error) => { unloaded = error; });
    if (unloaded) return postMessage({ id, failed: `the program cannot be started: ${unloaded.message}`, next: "load the page again" });
    if (files) {
      try {
        await put(files);
        return postMessage({ id, answer: null });
      } catch (error) {
        return postMessage({ id, failed: `a file cannot be read: ${error.message}`, next: "choose it again" });
      }
    }
    complaints = [];
    try {
      const { failed, next, ...answer } = call(request);
      if (failed !== undefined) return postMessage({ id, failed, next });
      const buffers = Object.values(answer).filter(ArrayBuffer.isView).map((array) => array.buffer);
      return postMessage({ id, answer }, buffers);
    } catch (error) {
      const [failed, next] = explained(error);
      return postMessage({ id, failed, next, trapped: true });
    }
  });
};

// Why the program ended.
function explained(error) {
  const lines = complaints.join("\n");
  const memory = exports.memory.buffer.byteLength / 2 ** 30;
  if (/memory allocation|capacity overflow/.test(lines) || memory > 3.5) {
    return [`not enough memory: a page has 4 GiB, and ${memory.toFixed(1)} GiB are in use`, "downsample, or select fewer samples; the command walpha has no such limit"];
  }
  const decoder = lines.match(/cannot be decoded: .*/);
  if (decoder) return [`the file ${decoder[0]}`, "it is damaged: copy it again; if other programs read it, please report it"];
  return [`the program ended unexpectedly: ${lines || error.message}`, "this is a bug in walpha: please report it, with the file if you can"];
}
