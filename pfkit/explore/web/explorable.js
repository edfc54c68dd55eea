/* The frame around a scene: stage, transport, readouts, controls, missions.
   It knows nothing about any algorithm. It plays a recorded run until the reader touches something,
   then asks an *engine* (Python in a worker, or a Jupyter kernel) to go on:
     engine.open(key, name, panel, seed) -> description
     engine.run(key, operations)         -> { drawing, report, ms }
   A classic script; adds PF.Explorable. */
(function (PF) {
  "use strict";

  const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
  let count = 0;

  function el(tag, attributes, ...children) {
    const e = document.createElement(tag);
    for (const [k, v] of Object.entries(attributes || {})) {
      if (k.startsWith("on")) e.addEventListener(k.slice(2), v);
      else if (v === true) e.setAttribute(k, "");
      else if (v !== false && v != null) e.setAttribute(k, v);
    }
    e.append(...children.filter((c) => c != null));
    return e;
  }
  PF.el = el;

  function tidy(value) {
    if (typeof value !== "number") return value;
    const a = Math.abs(value);
    let text = String(value);
    if (!Number.isInteger(value)) {
      text = a >= 100 ? value.toFixed(0) : a >= 10 ? value.toFixed(1)
        : a >= 0.01 || a === 0 ? value.toFixed(a < 1 ? 3 : 2) : value.toExponential(1);
    } else if (a >= 10000) text = value.toLocaleString("en-GB").replace(/,/g, "\u2009");
    return text.replace("-", "\u2212");
  }

  PF.Explorable = class {
    /* options: about (description), seed, recording (or null), engine() -> promise of an engine,
       missions (element or null), key, link (bool: offer links to the exact run) */
    constructor(root, options) {
      this.root = root;
      this.o = options;
      this.about = options.about;
      this.key = options.key || "x" + ++count;
      this.seed = options.seed;
      this.values = { ...options.values };
      this.initial = { ...this.values };
      this.history = [];
      this.pending = [];
      this.ticks = 0;
      this.mode = options.recording ? "recorded" : "idle";
      this.playing = Boolean(options.recording) && !still();
      this.visible = false;
      this.due = 0;
      this.fps = 0;
      this.frames = [];
      this.at = 0;
      this.done = [];
      this.build();
      if (options.recording) this.loadRecording(options.recording);
      this.observe();
      this.loop = this.loop.bind(this);
      requestAnimationFrame(this.loop);
    }

    /* ---- what the reader sees ------------------------------------------------------------- */
    build() {
      const a = this.about, r = this.root, id = "pf-" + this.key;
      r.classList.add("pf-explorable", "pf-upgraded");
      this.status = el("p", { class: "pf-status", role: "status", "aria-live": "polite" });
      this.canvas = el("canvas", {
        class: "pf-canvas", tabindex: "0", role: "application", "aria-label": a.alt || a.title,
        "aria-describedby": id + "-keys",
        onkeydown: (e) => this.keydown(e), onkeyup: (e) => this.keyup(e),
        onblur: () => this.release(),
      });
      this.renderer = new PF.Renderer(this.canvas, a.size);
      this.problem = el("div", { class: "pf-problem", role: "alert", hidden: true });
      this.bar = el("div", { class: "pf-progress", hidden: true }, el("div"));
      this.playButton = el("button", { type: "button", class: "pf-play",
        onclick: () => this.setPlaying(!this.playing) });
      this.seedInput = el("input", { type: "number", min: 0, max: 2147483647, step: 1,
        value: this.seed, onchange: () => this.restart(this.readSeed()) });
      this.timing = el("span", { class: "pf-timing", hidden: true });
      const button = (label, title, action) =>
        el("button", { type: "button", title, onclick: action }, label);
      this.liveButton = button("Go live", "Start Python in this page now", () => this.touch());
      this.transport = el("div", { class: "pf-transport" }, this.playButton,
        button("Step", "One tick", () => this.stepOnce()),
        button("Restart", "From the same seed", () => this.restart(this.readSeed())),
        el("label", { class: "pf-seed" }, "Seed ", this.seedInput),
        button("New seed", "Another run of the same experiment",
          () => this.restart((this.seed * 48271 + 11) % 9973)),
        this.liveButton,
        el("span", { class: "pf-spring" }),
        this.o.link ? button("Link to this run", "Put this exact run into the address",
          () => this.makeLink()) : null,
        button("Timing", "Frames per second and time per frame",
          () => { this.timing.hidden = !this.timing.hidden; }));
      this.readouts = el("dl", { class: "pf-readouts" });
      this.cells = {};
      this.controls = el("div", { class: "pf-controls" });
      this.inputs = {};
      for (const c of a.controls) if (c.kind !== "point") this.controls.append(this.control(c));
      this.point = a.controls.find((c) => c.kind === "point");
      if (this.point) this.listenToPointer();
      const keys = el("p", { class: "pf-keys", id: id + "-keys" }, this.keyHelp());
      const head = el("div", { class: "pf-head" }, el("p", { class: "pf-title" }, a.title),
        this.status);
      this.missions = this.buildMissions();
      r.replaceChildren(head, el("div", { class: "pf-stage" }, this.canvas, this.problem, this.bar),
        this.transport, this.timing, this.readouts, this.missions, this.controls, keys);
      this.say(this.mode === "recorded"
        ? "Recorded run. Touch any control and Python continues from here." : "Ready to start.");
      this.setPlaying(this.playing);
      this.theme();
    }

    buildMissions() {
      const own = this.o.missions;
      const items = own ? [...own.querySelectorAll(":scope > ol > li, :scope > ul > li")] : [];
      const list = el("ol", {});
      this.marks = [];
      const texts = items.length ? items : this.about.missions;
      texts.forEach((text, k) => {
        const mark = el("span", { class: "pf-mark", "aria-hidden": "true" }, String(k + 1));
        const word = el("span", { class: "pf-sr" });
        const body = el("div", {});
        if (typeof text === "string") body.textContent = text;
        else body.append(...text.childNodes);
        this.marks.push({ mark, word });
        list.append(el("li", {}, mark, word, body));
      });
      return el("div", { class: "pf-missions" }, el("p", { class: "pf-sub" }, "Try this"), list);
    }

    keyHelp() {
      const parts = ["With the picture in focus: space plays and pauses, full stop steps, r restarts"];
      for (const c of this.about.controls) {
        const keys = Object.keys(c.keys || {});
        if (!keys.length) continue;
        const names = keys.map((k) => ({ ArrowUp: "\u2191", ArrowDown: "\u2193", ArrowLeft: "\u2190",
          ArrowRight: "\u2192" }[k] || k)).join(" ");
        parts.push(`${names}: ${c.label.toLowerCase()}`);
      }
      return parts.join("; ") + ".";
    }

    control(c) {
      const id = `pf-${this.key}-${c.name}`;
      const help = c.help ? el("span", { class: "pf-help", id: id + "-help" }, c.help) : null;
      const described = c.help ? id + "-help" : null;
      const value = this.values[c.name] ?? c.default;
      let node, read, write;
      if (c.kind === "button") {
        node = el("div", { class: "pf-control pf-is-button" },
          el("button", { type: "button", "aria-describedby": described,
            onclick: () => this.change(c.name, true) }, c.label), help);
        write = () => {};
      } else if (c.kind === "toggle") {
        const box = el("input", { type: "checkbox", id, role: "switch", checked: value,
          "aria-describedby": described, onchange: () => this.change(c.name, box.checked) });
        node = el("div", { class: "pf-control pf-is-toggle" },
          el("label", { for: id }, box, el("span", {}, c.label)), help);
        write = (v) => { box.checked = v; };
      } else if (c.kind === "choice") {
        const group = el("div", { class: c.choices.length > 4 ? "" : "pf-segments" });
        if (c.choices.length > 4) {
          const select = el("select", { id, "aria-describedby": described,
            onchange: () => this.change(c.name, select.value) },
          ...c.choices.map(([k, label]) => el("option", { value: k, selected: k === value }, label)));
          group.append(select);
          node = el("div", { class: "pf-control" }, el("label", { for: id }, c.label), group, help);
          write = (v) => { select.value = v; };
        } else {
          const radios = c.choices.map(([k, label]) => {
            const radio = el("input", { type: "radio", name: id, value: k, checked: k === value,
              onchange: () => this.change(c.name, k) });
            group.append(el("label", {}, radio, el("span", {}, label)));
            return radio;
          });
          node = el("fieldset", { class: "pf-control", "aria-describedby": described },
            el("legend", {}, c.label), group, help);
          write = (v) => radios.forEach((r) => { r.checked = r.value === v; });
        }
      } else {
        const log = c.log && c.lo > 0;
        const to = (v) => log ? (1000 * Math.log(v / c.lo)) / Math.log(c.hi / c.lo) : v;
        const from = (p) => {
          const raw = log ? c.lo * Math.pow(c.hi / c.lo, p / 1000) : +p;
          const grid = log && raw > 20 * c.step ? Math.pow(10, Math.floor(Math.log10(raw)) - 1) : c.step;
          return Math.min(c.hi, Math.max(c.lo, +(Math.round(raw / grid) * grid).toFixed(8)));
        };
        const decimals = Math.max(0, Math.ceil(-Math.log10(c.step) - 1e-9));
        const shown = el("output", { for: id });
        const slider = el("input", { type: "range", id, min: log ? 0 : c.lo, max: log ? 1000 : c.hi,
          step: log ? 1 : c.step, "aria-describedby": described, oninput: () => {
            const v = from(slider.value);
            label(v);
            this.change(c.name, v);
          } });
        const label = (v) => {
          shown.textContent = (log ? tidy(v) : v.toFixed(decimals).replace("-", "\u2212")) + (c.unit ? "\u202f" + c.unit : "");
          slider.setAttribute("aria-valuetext", shown.textContent);
        };
        slider.value = to(value);
        label(value);
        node = el("div", { class: "pf-control" },
          el("label", { for: id }, c.label, shown), slider, help);
        write = (v) => { slider.value = to(v); label(v); };
      }
      this.inputs[c.name] = { write, spec: c };
      return node;
    }

    say(text) { if (this.status.textContent !== text) this.status.textContent = text; }

    theme() {
      const dark = PF.isDark(this.root.parentElement || document.body);
      this.root.classList.toggle("pf-dark", dark);
      this.renderer.dark = dark;
      if (this.renderer.last) this.renderer.draw(this.renderer.last);
    }

    observe() {
      const stage = this.canvas.parentElement;
      this.fit = () => {
        const width = Math.floor(stage.clientWidth);
        if (width > 0 && width !== this.renderer.width) this.renderer.resize(width);
        /* The picture stays in sight above its controls, if that leaves room for them. */
        const height = stage.offsetHeight;
        this.root.classList.toggle("pf-follow", height > 0 && height < 0.55 * innerHeight);
        this.root.style.setProperty("--pf-stage", `${height}px`);
      };
      new ResizeObserver(this.fit).observe(stage);
      addEventListener("resize", this.fit);
      new IntersectionObserver((entries) => {
        this.visible = entries[entries.length - 1].isIntersecting;
      }).observe(this.canvas);
      const watch = new MutationObserver(() => this.theme());
      for (const e of [document.documentElement, document.body]) {
        watch.observe(e, { attributes: true, attributeFilter: ["class", "data-theme",
          "data-jp-theme-light", "data-mode"] });
      }
    }

    /* ---- recorded ------------------------------------------------------------------------- */
    async loadRecording(recording) {
      this.frames = await PF.decode(recording);
      this.every = recording.every;
      // Who asked for no motion sees the end of the run; who did not sees it from its start.
      if (this.mode === "recorded") {
        this.at = this.playing ? 0 : this.frames.length - 1;
        this.showRecorded();
      }
    }

    showRecorded() {
      const f = this.frames[this.at];
      if (f) this.show(f.drawing, f.report);
    }

    /* ---- one frame ------------------------------------------------------------------------ */
    show(drawing, report) {
      if (!this.renderer.width) {
        this.renderer.resize(Math.floor(this.canvas.parentElement.clientWidth) || 700);
      }
      const start = performance.now();
      this.renderer.draw(drawing);
      this.drawMs = performance.now() - start;
      this.ticks = report.ticks;
      this.report = report;
      const now = performance.now();
      if (!this.toldAt || now - this.toldAt > 120 || !this.playing) {
        this.toldAt = now;
        this.tell(report);
      }
    }

    tell(report) {
      for (const [name, value] of Object.entries(report.readouts)) {
        if (!this.cells[name]) {
          const number = el("span", {});
          const unit = this.about.units[name];
          this.readouts.append(el("div", {}, el("dt", {}, name), el("dd", {}, number,
            unit ? el("span", { class: "pf-unit" }, unit) : null)));
          this.cells[name] = number;
        }
        const text = tidy(value);
        if (this.cells[name].textContent !== text) this.cells[name].textContent = text;
      }
      if (this.mode !== "live" || this.o.ticks === false) return;
      (report.done || []).forEach((done, k) => {
        const m = this.marks[k];
        if (!m || done === m.done) return;
        m.done = done;
        m.mark.parentElement.classList.toggle("pf-done", done);
        m.mark.textContent = done ? "\u2713" : String(k + 1);
        m.word.textContent = done ? "Done: " : "";
        if (done) this.say(`Mission ${k + 1} done.`);
      });
    }

    /* For hosts that throw pictures away, as a notebook does when a cell runs again. */
    destroy() {
      this.gone = true;
      removeEventListener("resize", this.fit);
    }

    loop(now) {
      if (this.gone) return;
      requestAnimationFrame(this.loop);
      const dt = Math.min(0.1, (now - (this.clock || now)) / 1000);
      this.clock = now;
      if (!this.root.isConnected) return;
      const run = this.playing && this.visible && !document.hidden;
      if (this.mode === "recorded" && run && this.frames.length) {
        this.due += (dt * this.about.rate) / this.every;
        if (this.due >= 1) {
          this.due %= 1;
          this.at = (this.at + 1) % this.frames.length;
          this.showRecorded();
        }
      } else if (this.mode === "live" && !this.busy) {
        if (run) this.due += dt * this.about.rate;
        const n = run ? Math.min(4, Math.floor(this.due + 0.05)) : 0;
        if (n > 0 || this.pending.length) {
          this.due = Math.max(0, Math.min(1, this.due - n));
          this.request(n);
        }
      }
    }

    /* Send what is pending and n ticks; draw the answer. */
    async request(n) {
      this.busy = true;
      const operations = this.pending;
      this.pending = [];
      operations.forEach((operation) => this.note(operation));
      if (n) operations.push(["step", n]);
      try {
        const answer = await this.engine.run(this.key, operations);
        this.accept(answer);
      } catch (error) {
        this.fail(error);
      }
      this.busy = false;
    }

    accept({ drawing, report, ms }) {
      this.show(drawing, report);
      const now = performance.now();
      if (this.drawnAt) this.fps += 0.1 * (1000 / Math.max(now - this.drawnAt, 1) - this.fps);
      this.drawnAt = now;
      this.pyMs = ms;
      this.framesDrawn = (this.framesDrawn || 0) + 1;
      if (!this.timing.hidden && this.framesDrawn % 12 === 0) {
        this.timing.textContent = `${this.fps.toFixed(0)} frames/s, Python ${ms.toFixed(1)} ms, `
          + `drawing ${this.drawMs.toFixed(1)} ms`;
      }
      for (const [name, value] of Object.entries(report.values || {})) {
        if (this.values[name] !== value && !this.pending.some((p) => p[1] === name)) {
          this.values[name] = value;
          if (this.inputs[name] && !this.held) this.inputs[name].write(value);
        }
      }
    }

    fail(error) {
      this.setPlaying(false);
      this.mode = "broken";
      this.problem.hidden = false;
      this.problem.replaceChildren(
        el("p", {}, "The scene stopped: " + String(error.message || error).slice(0, 400)),
        el("button", { type: "button", onclick: () => this.restart(this.seed) }, "Start it again"));
      this.say("The scene stopped with an error.");
    }

    /* ---- what the reader does ------------------------------------------------------------- */
    setPlaying(on) {
      if (on && this.mode === "idle") return void this.touch();
      this.playing = on;
      this.playButton.textContent = on ? "Pause" : "Play";
      this.playButton.setAttribute("aria-pressed", String(on));
      if (!on && this.report) {
        this.tell(this.report);
        if (this.mode === "live") this.say("Paused. " + this.sentence());
      } else if (this.mode === "live") this.say("Live: Python runs in this page.");
    }

    sentence() {
      return Object.entries(this.report.readouts)
        .map(([k, v]) => `${k} ${tidy(v)}${this.about.units[k] ? " " + this.about.units[k] : ""}`)
        .join(", ") + ".";
    }

    readSeed() {
      const seed = Math.round(+this.seedInput.value);
      return Number.isFinite(seed) && seed >= 0 && seed < 2147483648 ? seed : this.seed;
    }

    async stepOnce() {
      this.setPlaying(false);
      await this.touch();
      if (this.mode !== "live") return;
      while (this.busy) await new Promise((r) => setTimeout(r, 4));
      await this.request(1);
      this.say(this.sentence());
    }

    async restart(seed) {
      this.seed = seed;
      this.seedInput.value = seed;
      this.problem.hidden = true;
      if (this.mode === "live") {
        this.pending = [["reset", seed]];
        return;
      }
      if (this.mode === "broken") this.mode = "idle";
      this.history = [];
      this.initial = { ...this.values };
      this.ticks = 0;
      await this.touch(0);
    }

    change(name, value) {
      const spec = this.about.controls.find((c) => c.name === name);
      if (spec.kind !== "button" && spec.kind !== "point") this.values[name] = value;
      if (this.mode !== "live") {
        (this.waiting = this.waiting || []).push(["set", name, value]);
        this.touch();
        return;
      }
      const last = this.pending[this.pending.length - 1];
      if (last && last[0] === "set" && last[1] === name && spec.kind === "range") last[2] = value;
      else if (last && last[1] === name && spec.kind === "point" && last[2][2] === 1 && value[2] === 1) {
        last[2] = value;
      } else this.pending.push(["set", name, value]);
    }

    /* Remember what was done at which tick, so that a link can repeat it. What restarts a run also
       starts its history. */
    note([kind, name, value]) {
      const spec = this.about.controls.find((c) => c.name === name);
      if (kind === "reset" || (kind === "set" && spec && !spec.live)) {
        this.history = [];
        this.initial = { ...this.values };
        this.ticks = 0;
      } else if (kind === "set") this.history.push([this.ticks, name, value]);
    }

    keydown(e) {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      for (const c of this.about.controls) {
        if (!c.keys || !(e.key in c.keys)) continue;
        e.preventDefault();
        if (e.repeat) return;
        if (c.kind === "range") {
          this.held = { ...(this.held || {}), [c.name]: c };
        }
        if (!this.playing && c.kind === "range") this.setPlaying(true);
        this.change(c.name, c.keys[e.key]);
        return;
      }
      if (e.key === " ") { e.preventDefault(); this.setPlaying(!this.playing); }
      else if (e.key === ".") this.stepOnce();
      else if (e.key === "r") this.restart(this.readSeed());
    }

    keyup(e) {
      for (const c of Object.values(this.held || {})) {
        if (e.key in c.keys) {
          delete this.held[c.name];
          this.change(c.name, 0);
        }
      }
      if (this.held && !Object.keys(this.held).length) this.held = null;
    }

    release() {
      for (const c of Object.values(this.held || {})) this.change(c.name, 0);
      this.held = null;
    }

    listenToPointer() {
      const c = this.canvas;
      c.classList.add("pf-touchable");
      let down = false;
      const send = (e, phase) => {
        const at = this.renderer.locate(e.clientX, e.clientY);
        if (at) this.change(this.point.name, [+at[0].toFixed(4), +at[1].toFixed(4), phase]);
      };
      c.addEventListener("pointerdown", (e) => {
        down = true;
        c.setPointerCapture(e.pointerId);
        send(e, 0);
      });
      c.addEventListener("pointermove", (e) => { if (down) send(e, 1); });
      const up = (e) => { if (down) { down = false; send(e, 2); } };
      c.addEventListener("pointerup", up);
      c.addEventListener("pointercancel", up);
    }

    /* ---- live ----------------------------------------------------------------------------- */
    async touch(fromTick) {
      if (this.mode === "live") return;
      if (this.starting) return this.starting;
      this.starting = this.goLive(fromTick).finally(() => { this.starting = null; });
      return this.starting;
    }

    async goLive(fromTick) {
      this.liveButton.disabled = true;
      this.say("Starting Python\u2026");
      this.bar.hidden = false;
      const progress = (text, fraction) => {
        this.say(text);
        this.bar.firstChild.style.width = `${Math.round(100 * fraction)}%`;
      };
      try {
        this.engine = await this.o.engine(progress);
        await this.engine.open(this.key, this.about.name, this.about.panel, this.seed);
        const set = (this.waiting || []).map((w) => w[1]);
        const first = this.o.start || [];
        this.o.start = null;
        const values = Object.entries(this.initial)
          .filter(([k]) => this.inputs[k] && !set.includes(k)).map(([k, v]) => ["set", k, v]);
        const ticks = fromTick ?? this.ticks;
        const operations = [...values, ["reset", this.seed],
          ...(first.length ? first : ticks ? [["step", ticks]] : []), ...(this.waiting || [])];
        const answer = await this.engine.run(this.key, operations);
        this.mode = "live";
        this.root.dataset.mode = "live";
        this.ticks = ticks;
        (this.waiting || []).forEach((operation) => this.note(operation));
        this.waiting = null;
        this.accept(answer);
        if (first.length) {
          for (const [name, input] of Object.entries(this.inputs)) {
            if (name in answer.report.values) input.write(answer.report.values[name]);
          }
        }
        this.liveButton.hidden = true;
        this.say(this.playing ? "Live: Python runs in this page." : "Live and paused.");
        if (!this.playing && this.autoplay !== false && !still() && !this.frames.length) {
          this.setPlaying(true);
        }
      } catch (error) {
        this.waiting = null;
        this.liveButton.disabled = false;
        this.say("Python could not start: " + String(error.message || error).slice(0, 300));
      } finally {
        this.bar.hidden = true;
      }
    }

    /* ---- the exact run in the address ------------------------------------------------------ */
    makeLink() {
      const state = { id: this.o.id, seed: this.seed, n: this.ticks, v: {}, h: this.history };
      for (const [k, v] of Object.entries(this.initial)) if (this.inputs[k]) state.v[k] = v;
      let text = JSON.stringify(state);
      const whole = text.length <= 6000;
      if (!whole) text = JSON.stringify({ ...state, h: [], n: 0 });
      history.replaceState(null, "", "#run=" + encodeURIComponent(text));
      this.say(whole ? "The address of this page now names this exact run: copy it."
        : "Too many moves for a link: the address now names the seed and controls only.");
    }

    /* State from an address is data: known names, checked kinds, bounded numbers, or it is ignored.
       Python checks every value once more. */
    open(state) {
      const ok = (c, v) => c && (
        (c.kind === "range" && typeof v === "number" && Number.isFinite(v))
        || (c.kind === "toggle" && typeof v === "boolean") || (c.kind === "button" && v === true)
        || (c.kind === "choice" && c.choices.some(([k]) => k === v))
        || (c.kind === "point" && Array.isArray(v) && v.length === 3 && v.every(Number.isFinite)));
      const spec = (name) => this.about.controls.find((c) => c.name === name);
      if (Number.isInteger(state.seed) && state.seed >= 0 && state.seed < 2147483648) {
        this.seed = state.seed;
        this.seedInput.value = state.seed;
      }
      const n = Number.isInteger(state.n) ? Math.max(0, Math.min(20000, state.n)) : 0;
      for (const [name, value] of Object.entries(state.v && typeof state.v === "object" ? state.v : {})) {
        if (!ok(spec(name), value) || spec(name).kind === "button") continue;
        this.values[name] = this.initial[name] = value;
        this.inputs[name]?.write(value);
      }
      const start = [];
      let tick = 0;
      for (const entry of Array.isArray(state.h) ? state.h.slice(0, 400) : []) {
        if (!Array.isArray(entry)) continue;
        const [when, name, value] = entry;
        if (!Number.isInteger(when) || when < tick || when > n || !ok(spec(name), value)) continue;
        if (!spec(name).live) continue;
        if (when > tick) start.push(["step", when - tick]);
        tick = when;
        start.push(["set", name, value]);
        this.history.push([when, name, value]);
      }
      if (n > tick) start.push(["step", n - tick]);
      this.o.start = start;
      this.playing = false;
      this.setPlaying(false);
      this.autoplay = false;
      this.touch(0);
    }
  };
})((globalThis.PF = globalThis.PF || {}));
