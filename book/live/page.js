/* Brings the explorables of a book page to life. Loaded, after the scripts of pfkit/explore/web, only
   by pages that have one; see book/_ext/live_page.py. */
(function (PF) {
  "use strict";

  const me = document.currentScript;
  const BASE = me.src.replace(/[^/]*$/, "");
  const VERSION = me.dataset.version || "0";
  const LIVE = me.dataset.live === "1";
  const FROM_FOLDER = location.protocol === "file:";
  const PATIENCE = { seconds: 15 }; // without a byte; then the download counts as stalled
  PF.base = BASE;
  PF.patience = PATIENCE;

  PF.loadScript = function (name) {
    return new Promise((resolve, reject) => {
      const script = document.createElement("script");
      script.src = `${BASE}${name}?v=${VERSION}`;
      script.onload = resolve;
      script.onerror = () => reject(new Error(`${name} could not be loaded`));
      document.head.append(script);
    });
  };

  async function unpack(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
  }

  let bundle;
  function loadBundle() {
    bundle = bundle || PF.loadScript("bundle.js").catch((e) => { bundle = null; throw e; });
    return bundle;
  }

  /* The network in one sentence: browsers name a cut connection in many ways, none for readers. */
  function cut(name, signal) {
    throw signal.aborted ? signal.reason : new Error(`${name}: the connection was cut`);
  }

  async function request(name, signal) {
    const address = `${BASE}${name}?v=${VERSION}`;
    const response = await fetch(address, { signal }).catch(() => cut(name, signal));
    if (!response.ok) throw new Error(`${name} could not be fetched (${response.status})`);
    return response;
  }

  /* One file of Python from a web host; `onBytes` hears how much of it is there. */
  async function download(name, size, signal, onBytes) {
    const response = await request(name, signal);
    const reader = response.body.getReader(), whole = new Uint8Array(size);
    let got = 0;
    for (;;) {
      const { done, value } = await reader.read().catch(() => cut(name, signal));
      if (done) break;
      if (got + value.length > size) cut(name, signal);
      whole.set(value, got);
      onBytes(name, got += value.length);
    }
    if (got !== size) cut(name, signal);
    return whole.buffer;
  }

  /* Whether a shared worker may outlive its page here: a browser that can asks for the option. */
  function outlives() {
    let asked = false;
    const options = { get extendedLifetime() { asked = true; return true; } };
    try { new SharedWorker("data:text/javascript,", options); } catch { /* none, or not like this */ }
    return asked;
  }

  /* One worker with Python in it. `ask` sends a request and waits for its answer. That of lab cells
     (kind "cells") belongs to the page, so that Stop can end it. That of explorables (kind "scenes")
     is, where the browser lets it, shared by the pages of the book and lives on while the reader goes
     from one to the next, so that Python starts once. */
  PF.Python = class {
    constructor(kind) {
      this.kind = kind;
      this.waiting = new Map();
      this.next = 1;
      this.listeners = new Set();
    }

    onProgress(listener) { this.listeners.add(listener); }

    progress(text, fraction, loading) {
      for (const l of this.listeners) l(text, fraction);
      clearTimeout(this.alarm);
      if (!loading) return;
      const reason = `nothing arrived for ${PATIENCE.seconds} seconds. Is the network there?`;
      this.alarm = setTimeout(() => this.stop(reason), 1000 * PATIENCE.seconds);
    }

    start() {
      this.ready = this.ready || this.boot().catch((e) => { this.stop(); throw e; });
      return this.ready;
    }

    async boot() {
      if (!LIVE) throw new Error("this copy of the book was built without the parts that compute");
      const began = performance.now();
      const files = FROM_FOLDER ? await this.fromFolder() : null;
      this.connect(files
        ? URL.createObjectURL(new Blob([files["worker.js"]], { type: "text/javascript" }))
        : `${BASE}worker.js?v=${VERSION}`);
      this.kept = this.shared && await this.send({ do: "hello" });
      if (!this.kept) {
        const have = files || await this.fromHost();
        await this.send({ do: "boot", kind: this.kind, files: have }, Object.values(have));
      }
      this.bootMs = performance.now() - began;
    }

    connect(url) {
      this.shared = this.kind === "scenes" && !FROM_FOLDER && outlives();
      this.worker = this.shared ? new SharedWorker(url, { name: this.kind, extendedLifetime: true })
        : new Worker(url);
      this.port = this.worker.port || this.worker;
      this.port.onmessage = ({ data }) => {
        if (data.progress) return this.progress(data.progress, data.fraction);
        if (data.ended) return this.stop(data.ended);
        const waiting = this.waiting.get(data.id);
        this.waiting.delete(data.id);
        if (!waiting) return;
        if (data.error !== undefined) waiting.reject(new Error(data.error));
        else waiting.resolve(data.ok);
      };
      this.worker.onerror = (e) => {
        for (const w of this.waiting.values()) w.reject(new Error(e.message || "it could not be loaded"));
        this.waiting.clear();
      };
    }

    async fromFolder() {
      this.progress("Reading Python from the folder", 0.05);
      await loadBundle();
      const names = Object.keys(window.pfBundle), files = {};
      for (const [k, name] of names.entries()) {
        files[name] = await unpack(window.pfBundle[name]);
        this.progress("Unpacking Python", 0.1 + (0.6 * (k + 1)) / names.length);
      }
      return files;
    }

    async fromHost() {
      this.progress("Loading Python", 0, true);
      this.abort = new AbortController();
      const { signal } = this.abort, list = await request("manifest.json", signal);
      const sizes = await list.json(), names = Object.keys(sizes), have = {};
      const sum = (record) => Object.values(record).reduce((a, b) => a + b, 0), total = sum(sizes);
      const onBytes = (name, got) => {
        have[name] = got;
        const mb = (bytes) => (bytes / 1e6).toFixed(1), now = sum(have);
        this.progress(`Loading Python: ${mb(now)} of ${mb(total)} MB`, (0.7 * now) / total, now < total);
      };
      const parts = await Promise.all(names.map((n) => download(n, sizes[n], signal, onBytes)));
      return Object.fromEntries(names.map((n, k) => [n, parts[k]]));
    }

    send(message, transfer) {
      return new Promise((resolve, reject) => {
        const id = this.next++;
        this.waiting.set(id, { resolve, reject });
        this.port.postMessage({ id, ...message }, transfer || []);
      });
    }

    async ask(message) {
      await this.start();
      return this.send(message);
    }

    /* The only way to end a loop in Python: end the worker. The next request boots another. A shared
       one runs no code of readers; this page only takes its leave of it. */
    stop(reason) {
      clearTimeout(this.alarm);
      if (this.abort) this.abort.abort(new Error(reason || "stopped"));
      if (this.worker && this.shared) this.leave();
      else if (this.worker) this.worker.terminate();
      for (const w of this.waiting.values()) w.reject(new Error(reason || "stopped"));
      this.waiting.clear();
      this.ready = this.worker = this.port = null;
    }

    leave() {
      if (!this.port || !this.shared) return;
      this.port.postMessage({ do: "leave" });
      this.port.close();
    }
  };

  const scenes = new PF.Python("scenes");
  addEventListener("pagehide", ({ persisted }) => { if (!persisted) scenes.leave(); });
  async function drawn(message) {
    const answer = await scenes.ask(message);
    return { ...answer, report: JSON.parse(answer.report) };
  }

  async function engine(progress) {
    scenes.onProgress(progress);
    await scenes.start().finally(() => scenes.listeners.delete(progress));
    return {
      open: async (key, name, panel, seed) =>
        JSON.parse(await scenes.ask({ do: "open", key, name, panel, seed })),
      run: (key, operations) => drawn({ do: "run", key, operations: JSON.stringify(operations) }),
      many: (key, ticks, again) => drawn({ do: "many", key, ticks, again }),
    };
  }

  function stateFromAddress() {
    if (!location.hash.startsWith("#run=") || location.hash.length > 20000) return null;
    try {
      const state = JSON.parse(decodeURIComponent(location.hash.slice(5)));
      return state && typeof state === "object" ? state : null;
    } catch {
      return null;
    }
  }

  async function upgrade(root, k) {
    const key = root.dataset.recording;
    try {
      await PF.loadScript(`../live-runs/${key}.js`);
    } catch {
      return; // the still stays
    }
    const recording = window.pfRecordings[key];
    const explorable = new PF.Explorable(root, {
      about: recording.about, seed: recording.about.seed, values: recording.values, recording,
      key: "s" + k, id: root.id, link: true, engine, caption: root.dataset.caption,
    });
    root.pfExplorable = explorable;
    const state = stateFromAddress();
    if (state && state.id === root.id) {
      root.scrollIntoView();
      explorable.open(state);
    }
  }

  /* A way for the keyboard past all navigation: the second stop of the page, after the theme's own. */
  function offerSkip(root) {
    const skip = document.createElement("a");
    skip.className = "pf-skip";
    skip.href = `#${root.id}`;
    skip.textContent = "Skip to the moving picture";
    skip.addEventListener("click", (e) => {
      e.preventDefault();
      root.scrollIntoView({ block: "start" });
      const focus = () => root.pfExplorable ? root.pfExplorable.canvas.focus({ preventScroll: true })
        : requestAnimationFrame(focus);
      focus();
    });
    const theirs = document.querySelector("#pst-skip-link");
    if (theirs) theirs.after(skip);
    else document.body.prepend(skip);
  }

  function start() {
    const header = document.querySelector(".bd-header-article");
    if (header) document.documentElement.style.setProperty("--pf-top", `${header.offsetHeight}px`);
    const roots = [...document.querySelectorAll(".pf-explorable[data-recording]")];
    if (roots.length) offerSkip(roots[0]);
    const near = new IntersectionObserver((entries) => {
      for (const e of entries) {
        if (!e.isIntersecting) continue;
        near.unobserve(e.target);
        upgrade(e.target, roots.indexOf(e.target));
      }
    }, { rootMargin: "600px" });
    const wanted = stateFromAddress();
    for (const [k, root] of roots.entries()) {
      if (wanted && wanted.id === root.id) upgrade(root, k);
      else near.observe(root);
    }
  }
  PF.scenes = scenes;
  if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start);
  else start();
})((globalThis.PF = globalThis.PF || {}));
