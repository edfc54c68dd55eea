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

  /* One worker with Python in it. `ask` sends a request and waits for its answer. */
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
      const message = { kind: this.kind, base: BASE, version: VERSION };
      let url = `${BASE}worker.js?v=${VERSION}`;
      if (FROM_FOLDER) {
        this.progress("Reading Python from the folder", 0.05);
        await loadBundle();
        const names = Object.keys(window.pfBundle);
        message.files = {};
        for (const [k, name] of names.entries()) {
          message.files[name] = await unpack(window.pfBundle[name]);
          this.progress("Unpacking Python", 0.1 + (0.6 * (k + 1)) / names.length);
        }
        url = URL.createObjectURL(new Blob([message.files["worker.js"]], { type: "text/javascript" }));
      } else this.progress("Loading Python", 0, true);
      this.worker = new Worker(url);
      this.worker.onmessage = ({ data }) => {
        if (data.progress) return this.progress(data.progress, data.fraction, data.loading);
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
      await this.send({ do: "boot", ...message }, Object.values(message.files || {}));
      this.bootMs = performance.now() - began;
    }

    send(message, transfer) {
      return new Promise((resolve, reject) => {
        const id = this.next++;
        this.waiting.set(id, { resolve, reject });
        this.worker.postMessage({ id, ...message }, transfer || []);
      });
    }

    async ask(message) {
      await this.start();
      return this.send(message);
    }

    /* The only way to end a loop in Python: end the worker. The next request boots another. */
    stop(reason) {
      clearTimeout(this.alarm);
      if (this.worker) this.worker.terminate();
      for (const w of this.waiting.values()) w.reject(new Error(reason || "stopped"));
      this.waiting.clear();
      this.ready = this.worker = null;
    }
  };

  const scenes = new PF.Python("scenes");
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
