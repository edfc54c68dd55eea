/* Python in a worker. Two kinds of page part use it, each with a worker of its own: explorables
   (kind "scenes") and lab cells (kind "cells"), so that a reader's endless loop stops only itself.

   Messages in: { id, do, ... }; out: { id, ok | error } and { progress, fraction, loading }, the last
   true while bytes are expected from the network.
   On a web host the files are fetched; from a folder the page hands them over as ArrayBuffers. */
"use strict";

const MOST = 1e9; // bytes: beyond it Python gets a MemoryError, and the machine keeps the rest

let python, host, cells;

function tell(progress, fraction, loading) { postMessage({ progress, fraction, loading }); }

/* The network in one sentence: browsers name a cut connection in many ways, none for readers. */
function cut(name) { return () => { throw new Error(`${name}: the connection was cut`); }; }

async function asked(base, version, name) {
  const response = await fetch(`${base}${name}?v=${version}`).catch(cut(name));
  if (!response.ok) throw new Error(`${name} could not be fetched (${response.status})`);
  return response;
}

async function fetched(base, version, name, size, onBytes) {
  const reader = (await asked(base, version, name)).body.getReader(), parts = [];
  let got = 0;
  for (;;) {
    const { done, value } = await reader.read().catch(cut(name));
    if (done) break;
    parts.push(value);
    got += value.length;
    onBytes(name, got);
  }
  if (got !== size) cut(name)();
  const whole = new Uint8Array(got);
  let at = 0;
  for (const part of parts) { whole.set(part, at); at += part.length; }
  return whole.buffer;
}

async function collect({ base, version, files }) {
  if (files) return files;
  const sizes = await (await asked(base, version, "manifest.json")).json();
  const total = Object.values(sizes).reduce((a, b) => a + b, 0), have = {};
  const onBytes = (name, got) => {
    have[name] = got;
    const sum = Object.values(have).reduce((a, b) => a + b, 0);
    tell(`Loading Python: ${(sum / 1e6).toFixed(1)} of ${(total / 1e6).toFixed(1)} MB`, (0.7 * sum) / total,
      sum < total);
  };
  const names = Object.keys(sizes);
  const buffers = await Promise.all(names.map((n) => fetched(base, version, n, sizes[n], onBytes)));
  return Object.fromEntries(names.map((n, i) => [n, buffers[i]]));
}

function limitMemory() {
  const { grow } = WebAssembly.Memory.prototype;
  WebAssembly.Memory.prototype.grow = function (pages) {
    if (this.buffer.byteLength + 65536 * pages > MOST) throw new RangeError("the page's memory is used up");
    return grow.call(this, pages);
  };
}

async function boot(message) {
  limitMemory();
  const files = await collect(message);
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
  if (message.kind === "cells") {
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

const DO = {
  boot,
  open: (m) => host.open(m.key, m.name, m.panel, m.seed),
  run: (m) => drawn(() => host.do(m.key, m.operations)),
  many: (m) => drawn(() => host.many(m.key, m.ticks, m.again)),
  cell: (m) => cells.run(m.cells, m.index),
  memory: () => python._module.HEAP8.length,
  progress: (m) => cells.progress(m.lab),
  restore: (m) => cells.restore(m.lab, m.text),
  student: (m) => cells.student(m.lab, m.who, m.term),
  review: (m) => cells.review(m.lab, m.item, m.times),
  reviewed: (m) => cells.reviewed(m.lab, m.item, m.times, m.answer),
  solution: (m) => cells.solution(m.lab, m.item),
};

self.onmessage = async ({ data }) => {
  try {
    const ok = await DO[data.do](data);
    const transfer = ok && ok.drawing ? [ok.drawing.buffer] : [];
    postMessage({ id: data.id, ok }, transfer);
  } catch (error) {
    console.info(String(error.message || error)); // the whole traceback, for whoever looks
    postMessage({ id: data.id, error: short(error) });
  }
};
