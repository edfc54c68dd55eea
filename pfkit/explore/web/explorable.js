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

  const PAUSE = 2500; // ms between two sentences of a run
  const SILENCE = 20000; // ms of a run after which the readouts are said, if nothing happened

  /* A number with the decimals it always has, whatever its size. */
  function written(value, decimals) {
    if (typeof value !== "number") return value;
    const text = value.toFixed(decimals);
    if (Number(text) === 0) return text.replace("-", "");
    const [whole, part] = text.split(".");
    const grouped = Math.abs(value) < 10000 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, "\u2009");
    return (part ? `${grouped}.${part}` : grouped).replace("-", "\u2212");
  }

  PF.written = written;

  PF.Explorable = class {
    /* options: about (description), seed, recording (or null), engine() -> promise of an engine,
       key, link (bool: offer links to the exact run) */
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
      this.news = [];
      this.saidAt = 0;
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
      this.playButton = el("button", { type: "button", class: "pf-play",
        onclick: () => this.setPlaying(!this.playing) });
      this.seedInput = el("input", { type: "number", min: 0, max: 2147483647, step: 1,
        value: this.seed, onchange: () => this.restart(this.readSeed(), this.seedInput) });
      this.timing = el("span", { class: "pf-timing", hidden: true });
      const button = (label, title, action) =>
        el("button", { type: "button", title, onclick: action }, label);
      this.liveButton = button("Go live", "Start Python in this page now",
        () => this.touch(undefined, this.liveButton));
      this.transport = el("div", { class: "pf-transport" }, this.playButton,
        button("Step", "One tick", (e) => this.stepOnce(e.currentTarget)),
        button("Restart", "From the same seed",
          (e) => this.restart(this.readSeed(), e.currentTarget)),
        el("label", { class: "pf-seed" }, "Seed ", this.seedInput),
        button("New seed", "Another run of the same experiment",
          (e) => this.restart((this.seed * 48271 + 11) % 9973, e.currentTarget)),
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
      if (this.point) {
        this.hand = new PF.Hand(this.canvas, this.renderer, () => this.report?.handles || [],
          (x, y, phase, at) => this.change(this.point.name, [x, y, phase], this.canvas, at));
      }
      const keys = el("p", { class: "pf-keys", id: id + "-keys" }, this.keyHelp());
      const head = el("div", { class: "pf-head" }, el("p", { class: "pf-title" }, a.title),
        this.status);
      this.missions = new PF.Missions(a.missions, `${a.name}/${a.panel}`, (text) => this.hear(text));
      this.say(this.mode === "recorded"
        ? "Recorded run. Touch any control and Python continues from here." : "Ready to start.");
      r.replaceChildren(head, el("div", { class: "pf-stage" }, this.canvas, this.problem),
        this.transport, this.timing, this.readouts, this.missions.root, this.controls, keys);
      this.setPlaying(this.playing);
      this.theme();
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
      let node, write;
      if (c.kind === "button") {
        node = el("div", { class: "pf-control pf-is-button" },
          el("button", { type: "button", "aria-describedby": described,
            onclick: (e) => this.change(c.name, true, e.currentTarget) }, c.label), help);
        write = () => {};
      } else if (c.kind === "toggle") {
        const box = el("input", { type: "checkbox", id, role: "switch", checked: value,
          "aria-describedby": described, onchange: () => this.change(c.name, box.checked, box) });
        node = el("div", { class: "pf-control pf-is-toggle" },
          el("label", { for: id }, box, el("span", {}, c.label)), help);
        write = (v) => { box.checked = v; };
      } else if (c.kind === "choice") {
        const group = el("div", { class: c.choices.length > 4 ? "" : "pf-segments" });
        if (c.choices.length > 4) {
          const select = el("select", { id, "aria-describedby": described,
            onchange: () => this.change(c.name, select.value, select) },
          ...c.choices.map(([k, label]) => el("option", { value: k, selected: k === value }, label)));
          group.append(select);
          node = el("div", { class: "pf-control" }, el("label", { for: id }, c.label), group, help);
          write = (v) => { select.value = v; };
        } else {
          const radios = c.choices.map(([k, label]) => {
            const radio = el("input", { type: "radio", name: id, value: k, checked: k === value,
              onchange: () => this.change(c.name, k, radio) });
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
            label(from(slider.value));
            if (!thumb.undecided) act();
          } });
        const act = () => this.change(c.name, from(slider.value), slider);
        const thumb = new PF.Thumb(slider, act, (old) => { slider.value = old; label(from(old)); });
        const label = (v) => {
          shown.textContent = written(v, decimals) + (c.unit ? "\u202f" + c.unit : "");
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

    say(text) {
      this.saidAt = performance.now();
      if (this.status.textContent !== text) this.status.textContent = text;
    }

    /* What happened in the run is said one sentence at a time, and a run is never silent for long. */
    hear(sentence) { this.news = [...this.news.slice(-3), sentence]; }

    sayNews(running) {
      const quiet = performance.now() - this.saidAt;
      if (this.news.length && quiet > PAUSE) this.say(this.news.shift());
      else if (running && quiet > SILENCE) this.say(this.sentence(3));
    }

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
        const text = written(value, this.about.decimals[name]);
        if (this.cells[name].textContent !== text) this.cells[name].textContent = text;
      }
    }

    /* For hosts that throw pictures away, as a notebook does when a cell runs again. */
    destroy() {
      this.gone = true;
      this.missions.destroy();
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
      } else if (this.mode === "live") this.sayNews(run);
      if (this.mode === "live" && !this.busy) {
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
      for (const sentence of report.told || []) this.hear(sentence);
      this.missions.judge(report.done);
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
      if (on && this.mode === "idle") return void this.touch(undefined, this.playButton);
      this.playing = on;
      this.playButton.textContent = on ? "Pause" : "Play";
      this.playButton.setAttribute("aria-pressed", String(on));
      if (!on && this.report) {
        this.tell(this.report);
        if (this.mode === "live") this.say("Paused. " + this.sentence());
      } else if (this.mode === "live") this.say("Live: Python runs in this page.");
    }

    sentence(most) {
      const { units, decimals } = this.about;
      return Object.entries(this.report.readouts).slice(0, most)
        .map(([k, v]) => `${k} ${written(v, decimals[k])}${units[k] ? " " + units[k] : ""}`)
        .join(", ") + ".";
    }

    readSeed() {
      const seed = Math.round(+this.seedInput.value);
      return Number.isFinite(seed) && seed >= 0 && seed < 2147483648 ? seed : this.seed;
    }

    async stepOnce(control) {
      this.setPlaying(false);
      await this.touch(undefined, control);
      if (this.mode !== "live") return;
      while (this.busy) await new Promise((r) => setTimeout(r, 4));
      await this.request(1);
      this.say(this.sentence());
    }

    async restart(seed, control) {
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
      await this.touch(0, control);
    }

    change(name, value, control, at) {
      const spec = this.about.controls.find((c) => c.name === name);
      if (spec.kind !== "button" && spec.kind !== "point") this.values[name] = value;
      const last = this.pending[this.pending.length - 1];
      if (last && last[0] === "set" && last[1] === name && spec.kind === "range") last[2] = value;
      else if (last && last[1] === name && spec.kind === "point" && last[2][2] === 1 && value[2] === 1) {
        last[2] = value;
      } else this.pending.push(["set", name, value]);
      if (this.mode !== "live") this.touch(undefined, control, at);
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
        e.stopPropagation();
        if (e.repeat) return;
        if (c.kind === "range") {
          this.held = { ...(this.held || {}), [c.name]: c };
        }
        if (!this.playing && c.kind === "range") this.setPlaying(true);
        this.change(c.name, c.keys[e.key], this.canvas);
        return;
      }
      const act = { " ": () => this.setPlaying(!this.playing), ".": () => this.stepOnce(this.canvas),
        r: () => this.restart(this.readSeed(), this.canvas) }[e.key];
      if (!act) return;
      e.preventDefault();
      e.stopPropagation();
      if (!e.repeat) act();
    }

    keyup(e) {
      for (const c of Object.values(this.held || {})) {
        if (e.key in c.keys) {
          delete this.held[c.name];
          this.change(c.name, 0, this.canvas);
        }
      }
      if (this.held && !Object.keys(this.held).length) this.held = null;
    }

    release() {
      for (const c of Object.values(this.held || {})) this.change(c.name, 0, this.canvas);
      this.held = null;
    }

    /* ---- live ----------------------------------------------------------------------------- */
    /* control: what the reader pressed, which then shows the progress; at: where in the picture */
    async touch(fromTick, control, at = null) {
      if (this.mode === "live") return;
      control = control || (this.liveButton.hidden ? this.playButton : this.liveButton);
      this.starting = this.starting
        || this.goLive(fromTick, control, at).finally(() => { this.starting = null; });
      return this.starting;
    }

    async goLive(fromTick, control, at) {
      this.liveButton.disabled = true;
      if (this.loading) this.loading.box.remove();
      this.loading = new PF.Loading(control, (text) => this.say(text), at);
      try {
        this.engine = await this.o.engine((text, fraction) => this.loading.progress(text, fraction));
        await this.engine.open(this.key, this.about.name, this.about.panel, this.seed);
        const answer = await this.engine.run(this.key, this.firstOperations(fromTick));
        this.loading.done();
        this.mode = "live";
        this.root.dataset.mode = "live";
        this.accept(answer);
        this.liveButton.hidden = true;
        this.say(this.playing ? "Live: Python runs in this page." : "Live and paused.");
        if (!this.playing && this.autoplay !== false && !still() && !this.frames.length) {
          this.setPlaying(true);
        }
      } catch (error) {
        this.liveButton.disabled = false;
        this.loading.fail("Python could not start: " + String(error.message || error).slice(0, 300),
          () => this.touch(fromTick, control, at));
      }
    }

    /* The run on the screen, made again: its controls, its seed, its ticks or the moves of a link. What
       the reader did meanwhile comes after it and is the first that counts as the reader's. */
    firstOperations(fromTick) {
      const mine = this.pending;
      this.pending = [];
      const changed = mine.map((operation) => operation[1]);
      const values = Object.entries(this.initial)
        .filter(([k]) => this.inputs[k] && !changed.includes(k)).map(([k, v]) => ["set", k, v]);
      const ticks = fromTick ?? this.ticks;
      const past = this.o.start?.length ? this.o.start : ticks ? [["step", ticks]] : [];
      this.o.start = null;
      this.ticks = past.reduce((sum, [kind, n]) => sum + (kind === "step" ? n : 0), 0);
      mine.forEach((operation) => this.note(operation));
      return [...values, ["reset", this.seed], ...past, ["watch"], ...mine];
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
