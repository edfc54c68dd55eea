/* Python in a worker. Two kinds of page part use it, each with a worker of its own: explorables
   (kind "scenes") and lab cells (kind "cells"), so that a reader's endless loop stops only itself.
   One of scenes may be shared by several pages (see page.js): each is a client with its own runs.

   Messages in: { id, do, ... }; out: { id, ok | error }, { progress, fraction }, and { ended } when
   a shared worker is of no more use. The page hands over all files as ArrayBuffers. */
"use strict";

const MOST = 1e9; // bytes: beyond it Python gets a MemoryError, and the machine keeps the rest
const SHARED = "onconnect" in self;

let python, host, cells, booting = null, clients = new Set(), met = 0;

function tell(progress, fraction) {
  for (const client of clients) client.port.postMessage({ progress, fraction });
}

function limitMemory() {
  const { grow } = WebAssembly.Memory.prototype;
  WebAssembly.Memory.prototype.grow = function (pages) {
    if (this.buffer.byteLength + 65536 * pages > MOST) throw new RangeError("the page's memory is used up");
    return grow.call(this, pages);
  };
}

async function boot({ kind, files }) {
  limitMemory();
  const text = (name) => new TextDecoder().decode(files[name]);
  const types = { wasm: "application/wasm", json: "application/json", zip: "application/zip" };
  /* Pyodide asks for its files by address; whatever the address, it gets the bytes we hold. */
  self.fetch = async (request) => {
    const name = String(request.url || request).split("/").pop().split("?")[0];
    if (!(name in files)) throw new TypeError(`${name} is not part of this page`);
    return new Response(files[name], { headers: { "content-type": types[name.split(".").pop()] || "" } });
  };
  tell("Starting Python", 0.72);
  (0, eval)(text("pyodide.js"));
  (0, eval)(text("pyodide.asm.js"));
  python = await loadPyodide({ indexURL: "https://this.page/", stdout: () => {}, stderr: () => {} });
  tell("Unpacking NumPy", 0.85);
  const folder = { extractDir: "/lib/python3.12/site-packages" };
  python.unpackArchive(files["numpy.zip"], "zip", folder);
  python.unpackArchive(files["pfkit.zip"], "zip", folder);
  /* Cells of a chapter read "../data": stand beside it, as notebooks do. */
  python.runPython(`import os
os.makedirs("${folder.extractDir}/notebooks", exist_ok=True)
os.chdir("${folder.extractDir}/notebooks")`);
  tell("Importing pfkit", 0.9);
  python.runPython("from pfkit.explore.wasm import accept_int64; accept_int64()");
  if (kind === "cells") {
    cells = python.runPython("from pfkit.labs.cells import Cells; Cells()");
  } else host = python.runPython("import pfkit.explore.host as h; h.Host()");
  /* From here on nothing may be fetched: what the page computes stays in the page. */
  for (const name of ["fetch", "XMLHttpRequest", "WebSocket", "EventSource", "WebTransport",
    "importScripts", "Worker", "BroadcastChannel", "indexedDB", "caches"]) {
    for (let o = self; o; o = Object.getPrototypeOf(o)) {
      if (Object.prototype.hasOwnProperty.call(o, name)) delete o[name];
    }
    Object.defineProperty(self, name, { value: undefined, writable: false, configurable: false });
  }
  tell("Ready", 1);
  return true;
}

/* A Python error is told by its last line; the traceback is for lab cells only. */
function short(error) {
  const lines = String(error.message || error).trim().split("\n");
  return lines[lines.length - 1].replace(/^pfkit\.errors\./, "");
}

/* A drawing and its report out of Python's hands, and how long that took. */
function drawn(make) {
  const start = performance.now();
  const pair = make();
  const proxy = pair.get(0), report = pair.get(1);
  const view = proxy.getBuffer("f32");
  const drawing = view.data.slice();
  view.release();
  proxy.destroy();
  pair.destroy();
  return { drawing, report, ms: performance.now() - start };
}

/* A client that goes takes its runs along. */
function leave(client) {
  clients.delete(client);
  for (const key of client.keys) {
    host.runs.pop(key, undefined);
    host.seeds.pop(key, undefined);
  }
}

const own = (m, client) => `${client.name}/${m.key}`;
const DO = {
  hello: () => booting || false,
  boot(m) {
    booting = booting || boot(m);
    return booting;
  },
  leave: (m, client) => leave(client),
  open(m, client) {
    client.keys.add(own(m, client));
    return host.open(own(m, client), m.name, m.panel, m.seed);
  },
  run: (m, client) => drawn(() => host.do(own(m, client), m.operations)),
  many: (m, client) => drawn(() => host.many(own(m, client), m.ticks, m.again)),
  cell: (m) => cells.run(m.cells, m.index),
  memory: () => python._module.HEAP8.length,
  progress: (m) => cells.progress(m.lab),
  restore: (m) => cells.restore(m.lab, m.text),
  student: (m) => cells.student(m.lab, m.who, m.term),
  review: (m) => cells.review(m.lab, m.item, m.times),
  reviewed: (m) => cells.reviewed(m.lab, m.item, m.times, m.answer),
  solution: (m) => cells.solution(m.lab, m.item),
};

/* What is no error of Python's is the end of Python; the next page must not meet it. */
function isEnd(error) {
  return SHARED && !(python && error instanceof python.ffi.PythonError);
}

async function serve(client, data) {
  try {
    const ok = await DO[data.do](data, client);
    const transfer = ok && ok.drawing ? [ok.drawing.buffer] : [];
    client.port.postMessage({ id: data.id, ok }, transfer);
  } catch (error) {
    console.info(String(error.message || error)); // the whole traceback, for whoever looks
    client.port.postMessage({ id: data.id, error: short(error) });
    if (!isEnd(error)) return;
    for (const other of clients) other.port.postMessage({ ended: short(error) });
    self.close();
  }
}

function meet(port) {
  const client = { port, name: ++met, keys: new Set() };
  clients.add(client);
  port.onmessage = ({ data }) => serve(client, data);
}

if (SHARED) self.onconnect = ({ ports }) => meet(ports[0]);
else meet(self);
