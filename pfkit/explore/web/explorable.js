/* The frame around a scene: picture, sentence, time, controls, readouts, missions.
   It knows nothing about any algorithm. It plays a recorded run until the reader touches something,
   then asks an *engine* (Python in a worker, or a Jupyter kernel) to go on:
     engine.open(key, name, panel, seed)  -> description
     engine.run(key, operations)          -> { drawing, report, ms }
     engine.many(key, ticks, again)       -> { drawing, report, ms }
   The operations are those of pfkit/explore/host.py. A panel without controls, or what has a caption,
   is a film: picture, sentence, play and scrub. A classic script; adds PF.Explorable. */
(function (PF) {
  "use strict";

  const { el, written } = PF;
  const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
  const PAUSE = 2500; // ms between two sentences about what must not be missed
  const QUIET = 5000; // ms of a run after which the last phase is told, if nothing happened
  const LEAST = 150; // px: no picture is made lower to fit the screen
  const MARGIN = 24; // px above and below all that
  const MOST_REPLAY = 20000; // ticks
  let count = 0;

  PF.Explorable = class {
    /* options: about (description), seed, recording (or null), engine() -> promise of an engine,
       key, link (bool: offer links to the exact run), caption */
    constructor(root, options) {
      this.root = root;
      this.o = options;
      this.about = options.about;
      this.film = Boolean(options.caption) || !this.about.controls.length;
      this.key = options.key || "x" + ++count;
      this.seed = options.seed;
      this.values = { ...options.values };
      this.initial = { ...this.values };
      this.goal = null; // the tick that the reader scrubs to, until it is shown
      this.compared = null; // { name, value } of the second world's control
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
      this.position = 0; // in the recording, in frames
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
      const a = this.about, id = "pf-" + this.key;
      this.root.classList.add("pf-explorable", "pf-upgraded");
      this.root.classList.toggle("pf-film", this.film);
      this.status = el("p", { class: "pf-status", role: "status", "aria-live": "polite" });
      this.canvas = el("canvas", {
        class: "pf-canvas", tabindex: "0", role: this.film ? "img" : "application",
        "aria-label": a.alt || a.title, "aria-describedby": this.film ? null : id + "-keys",
        onkeydown: (e) => this.keydown(e), onkeyup: (e) => this.keyup(e),
        onblur: () => this.release(),
      });
      this.renderer = new PF.Renderer(this.canvas, a.size);
      this.problem = el("div", { class: "pf-problem", role: "alert", hidden: true });
      this.stage = el("div", { class: "pf-stage" }, this.canvas, this.problem);
      this.transport = new PF.Transport(id, a.rate, {
        play: () => this.setPlaying(!this.playing),
        phase: (control) => this.nextPhase(control),
        speed: (pick, control) => { if (pick === "phase") this.touch(undefined, control); },
        scrub: (tick, control) => this.scrub(tick, control),
      }, this.film);
      this.chips = el("ol", { class: "pf-phases", "aria-hidden": "true" },
        ...(a.phases.length > 1 ? a.phases.map((name) => el("li", {}, name)) : []));
      const says = el("div", { class: "pf-says" }, this.chips, this.status);
      this.main = el("div", { class: "pf-controls pf-main" });
      this.inputs = {};
      this.missions = new PF.Missions(a.missions, `${a.name}/${a.panel}`, (text) => this.hear(text));
      if (!this.film) {
        this.hand = new PF.Hand(this.canvas, this.renderer, {
          act: (...hold) => this.hold(...hold), floor: a.floor, say: (text) => this.say(text) });
      }
      const see = el("div", { class: "pf-see" }, this.stage, says, this.transport.root,
        this.transport.late);
      const title = el("p", { class: "pf-title", hidden: this.film }, a.title);
      this.root.replaceChildren(title,
        el("div", { class: "pf-bench" }, see, this.film ? null : this.main),
        ...(this.film ? [this.o.caption ? el("p", { class: "pf-caption" }, this.o.caption) : ""]
          : this.below(id)));
      this.say(this.mode === "idle" ? "Ready to start." : this.film ? ""
        : "A recorded run. Touch anything and Python goes on from here.");
      this.status.setAttribute("aria-live", this.mode === "recorded" ? "off" : "polite");
      this.setPlaying(this.playing);
      this.theme();
    }

    /* Tools, more controls, readouts, missions. */
    below(id) {
      const a = this.about, more = el("div", { class: "pf-controls" });
      for (const c of a.controls) (c.main ? this.main : more).append(this.control(c));
      this.seedInput = el("input", { type: "number", min: 0, max: 2147483647, step: 1,
        value: this.seed, onchange: () => this.restart(this.readSeed(), this.seedInput) });
      this.timing = el("span", { class: "pf-timing", hidden: true });
      const button = (label, title, action) =>
        el("button", { type: "button", title, onclick: action }, label);
      this.liveButton = button("Go live", "Start Python in this page now",
        () => this.touch(undefined, this.liveButton));
      this.compareSelect = el("select", { onchange: () => this.compare(this.compareSelect.value) },
        el("option", { value: "" }, "one world"),
        ...a.controls.filter((c) => c.kind !== "button" && !Object.keys(c.keys || {}).length)
          .map((c) => el("option", { value: c.name }, "two worlds: " + c.label)));
      this.many = a.score ? new PF.Many(a, (...work) => this.engine.many(this.key, ...work),
        (text) => this.hear(text)) : null;
      const tools = el("div", { class: "pf-tools" },
        button("Restart", "From the same seed", (e) => this.restart(this.readSeed(), e.currentTarget)),
        el("label", { class: "pf-seed" }, "Seed ", this.seedInput),
        button("New seed", "Another run of the same experiment",
          (e) => this.restart((this.seed * 48271 + 11) % 9973, e.currentTarget)),
        el("label", { class: "pf-seed" }, "Compare ", this.compareSelect),
        this.many ? button("Run 100 seeds", `How often? The ${a.score} of 100 runs`,
          (e) => this.runMany(e.currentTarget)) : null,
        this.liveButton, el("span", { class: "pf-spring" }),
        this.o.link ? button("Link to this run", "Put this exact run into the address",
          () => this.makeLink()) : null,
        button("Timing", "Frames per second and time per frame",
          () => { this.timing.hidden = !this.timing.hidden; }));
      this.readouts = el("dl", { class: "pf-readouts" });
      this.cells = {};
      const keys = el("p", { class: "pf-keys", id: id + "-keys" }, this.keyHelp());
      return [tools, this.timing, this.many?.root,
        more.childElementCount ? el("details", { class: "pf-more" },
          el("summary", {}, `${more.childElementCount} more controls`), more) : null,
        this.readouts, this.missions.root, keys].filter(Boolean);
    }

    keyHelp() {
      const parts = ["With the picture in focus: space plays and pauses, full stop goes on by a phase, "
        + "r restarts, h takes hold of what can be dragged"];
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
      const value = this.values[c.name] ?? c.default, id = `pf-${this.key}-${c.name}`;
      const { node, write } = PF.control(c, id, value, (v, e) => this.change(c.name, v, e));
      this.inputs[c.name] = { write, spec: c, node };
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
      else if (running && !this.transport.byPhase && quiet > QUIET) this.say(this.sentence());
    }

    /* The last phase in words; of two worlds, what each says. */
    sentence() {
      const { sentences } = this.report.phase;
      const told = sentences.filter(Boolean);
      if (!told.length) return this.numbers();
      return told.length > 1 ? `Left: ${told[0]} Right: ${told[1]}` : told[0];
    }

    numbers() {
      const { units, decimals } = this.about;
      return Object.entries(this.report.readouts[0]).slice(0, 3)
        .map(([k, v]) => `${k} ${written(v, decimals[k])}${units[k] ? " " + units[k] : ""}`)
        .join(", ") + ".";
    }

    theme() {
      const dark = PF.isDark(this.root.parentElement || document.body);
      this.root.classList.toggle("pf-dark", dark);
      this.renderer.dark = dark;
      this.many?.theme(dark);
      if (this.renderer.last) this.renderer.draw(this.renderer.last);
    }

    /* Picture, sentence, time and main controls are on the screen together: what is left of its height
       is the picture's. */
    fit() {
      const width = Math.floor(this.stage.clientWidth);
      if (!width) return;
      const top = parseFloat(getComputedStyle(document.documentElement).getPropertyValue("--pf-top")) || 0;
      const rest = this.root.querySelector(".pf-bench").offsetHeight - this.stage.offsetHeight;
      const beside = this.stage.clientWidth < 0.9 * this.root.clientWidth;
      const below = beside ? this.transport.root.offsetHeight + this.status.parentElement.offsetHeight
        + this.transport.late.offsetHeight : rest;
      const title = this.root.firstElementChild.offsetHeight;
      const most = Math.max(LEAST, innerHeight - top - below - title - MARGIN);
      this.renderer.resize(width, most, this.compared ? 2 : 1);
    }

    observe() {
      this.refit = () => this.fit();
      new ResizeObserver(this.refit).observe(this.stage.parentElement.parentElement);
      addEventListener("resize", this.refit);
      new IntersectionObserver((entries) => {
        this.visible = entries[entries.length - 1].isIntersecting;
      }).observe(this.canvas);
      const watch = new MutationObserver(() => this.theme());
      for (const e of [document.documentElement, document.body]) {
        watch.observe(e, { attributes: true, attributeFilter: ["class", "data-theme",
          "data-jp-theme-light", "data-mode"] });
      }
    }

    /* For hosts that throw pictures away, as a notebook does when a cell runs again. */
    destroy() {
      this.gone = true;
      this.missions.destroy();
      removeEventListener("resize", this.refit);
    }

    /* ---- recorded ------------------------------------------------------------------------- */
    async loadRecording(recording) {
      this.frames = await PF.decode(recording);
      this.every = recording.every;
      if (this.mode !== "recorded") return;
      // Who asked for no motion sees the end of the run; who did not sees it from its start.
      this.position = this.playing ? 0 : this.frames.length - 1;
      this.showRecorded();
    }

    /* The place in the recording: a stored frame, or between two of them. */
    showRecorded() {
      const last = this.frames.length - 1;
      this.at = Math.min(last, Math.floor(this.position));
      const frame = this.frames[this.at], share = this.position - this.at;
      const drawing = share > 0 && this.at < last
        ? PF.tween(frame, this.frames[this.at + 1], share) : frame.drawing;
      this.show(drawing, frame.report);
      this.ticks = Math.round(Math.min(this.position, last) * this.every);
      this.transport.show(this.ticks, [0, last * this.every], true);
      const told = frame.report.phase.sentences[0];
      if (told && !this.starting && (this.film || performance.now() - this.saidAt > QUIET)) this.say(told);
    }

    /* ---- one frame ------------------------------------------------------------------------ */
    show(drawing, report) {
      if (!this.renderer.width) this.fit();
      if (!this.renderer.width) this.renderer.resize(700);
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
      for (const chip of this.chips.children) {
        chip.classList.toggle("pf-now", chip.textContent === report.phase.name);
      }
      if (this.film) return;
      for (const name of Object.keys(report.readouts[0])) {
        if (!this.cells[name]) {
          const number = el("span", {}), unit = this.about.units[name];
          this.readouts.append(el("div", {}, el("dt", {}, name), el("dd", {}, number,
            unit ? el("span", { class: "pf-unit" }, unit) : null)));
          this.cells[name] = number;
        }
        const text = report.readouts
          .map((one) => written(one[name] ?? "\u2013", this.about.decimals[name])).join(" | ");
        if (this.cells[name].textContent !== text) this.cells[name].textContent = text;
      }
    }

    loop(now) {
      if (this.gone) return;
      requestAnimationFrame(this.loop);
      const dt = Math.min(0.1, (now - (this.clock || now)) / 1000);
      this.clock = now;
      if (!this.root.isConnected) return;
      const run = this.playing && this.visible && !document.hidden;
      if (this.mode === "recorded" && run && this.frames.length) {
        this.position += (dt * this.about.rate * this.transport.speed) / this.every;
        if (this.position >= this.frames.length - 1 + (this.film ? 8 : 0)) this.position = 0;
        this.showRecorded();
      }
      if (this.mode !== "live") return;
      if (!run) this.transport.began = 0; // who stands still is not late
      this.sayNews(run);
      if (this.many) this.many.work(run);
      if (this.fresh) this.draw(run, dt);
      else if (!this.busy) this.ask(run, dt);
    }

    /* An answer is there: ask for the next one before it is drawn, so that both go on at once. */
    draw(run, dt) {
      const answer = this.fresh;
      this.fresh = null;
      this.ticks = answer.report.ticks;
      this.ask(run, dt);
      this.accept(answer);
    }

    ask(run, dt) {
      const go = run && !this.transport.resting;
      if (go) this.due += dt * this.about.rate * this.transport.speed;
      else this.due = 0;
      const n = go ? Math.min(4, Math.floor(this.due + 0.05)) : 0;
      if (n < 1 && !this.pending.length) return;
      this.due = Math.max(0, Math.min(1, this.due - n));
      this.request(n ? [this.transport.byPhase ? "phase" : "step", n] : null);
    }

    /* Send what is pending and, at most, one way on. The answer is drawn in the next frame. */
    async request(on) {
      this.busy = true;
      const operations = this.pending;
      this.pending = [];
      operations.forEach((operation) => this.note(operation));
      if (on || operations.some(([kind]) => kind !== "back")) this.goal = null;
      if (on) {
        this.trim();
        operations.push(on);
      }
      try {
        this.fresh = await this.engine.run(this.key, operations);
      } catch (error) {
        this.fail(error);
      }
      this.busy = false;
    }

    accept({ drawing, report, ms }) {
      const ended = this.report ? report.phase.count !== this.report.phase.count : true;
      this.show(drawing, report);
      for (const sentence of report.told || []) this.hear(sentence);
      this.missions.judge(report.done);
      if (this.goal === null || this.goal === report.ticks) { // else the bar is ahead of the answer
        this.goal = null;
        this.transport.show(report.ticks, report.kept);
      }
      if (ended && this.transport.byPhase && report.phase.name) {
        this.transport.ended();
        this.tell(report);
        this.say(this.sentence());
      }
      if (this.playing) this.transport.pace(report.ticks, ms);
      const now = performance.now();
      if (this.drawnAt) this.fps += 0.1 * (1000 / Math.max(now - this.drawnAt, 1) - this.fps);
      this.drawnAt = now;
      this.framesDrawn = (this.framesDrawn || 0) + 1;
      if (!this.timing.hidden && this.framesDrawn % 12 === 0) {
        this.timing.textContent = `${this.fps.toFixed(0)} frames/s, Python ${ms.toFixed(1)} ms, `
          + `drawing ${this.drawMs.toFixed(1)} ms`;
      }
      this.follow(report.values);
    }

    /* Controls show what the scene says they are: a handle may have moved one. */
    follow(values) {
      for (const [name, value] of Object.entries(values || {})) {
        if (this.values[name] === value || this.pending.some((p) => p[1] === name)) continue;
        this.values[name] = value;
        if (this.inputs[name] && !this.keysHeld) this.inputs[name].write(value);
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
      if (on && this.mode === "idle") return void this.touch(undefined, this.transport.play);
      this.playing = on;
      this.transport.playing(on);
      if (on && this.film && this.position >= this.frames.length - 1) this.position = 0;
      if (on || !this.report) return;
      if (this.mode === "recorded") {
        this.position = this.at; // what stands still is a frame that was stored, with its readouts
        this.showRecorded();
      }
      this.tell(this.report);
      if (this.mode === "live") this.say("Paused. " + this.sentence());
    }

    readSeed() {
      const seed = Math.round(+this.seedInput.value);
      return Number.isFinite(seed) && seed >= 0 && seed < 2147483648 ? seed : this.seed;
    }

    /* What is on its way has come back. */
    async idle() {
      while (this.busy || this.fresh) await new Promise((r) => setTimeout(r, 4));
    }

    async nextPhase(control) {
      this.setPlaying(false);
      await this.touch(undefined, control);
      if (this.mode !== "live") return;
      await this.idle();
      await this.request(["phase", Math.ceil(4 * this.about.rate)]);
      await this.idle();
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

    scrub(tick, control) {
      this.setPlaying(false);
      if (this.mode === "recorded") {
        this.position = Math.min(this.frames.length - 1, tick / this.every);
        this.showRecorded();
      } else if (this.mode === "live") {
        this.goal = tick;
        this.push(["back", tick], (last) => last[0] === "back");
        this.idle().then(() => this.say(this.sentence()));
      } else this.touch(undefined, control);
    }

    /* One more thing to do; takes the place of the last one if that is overtaken by it. */
    push(operation, overtakes) {
      const last = this.pending[this.pending.length - 1];
      if (last && overtakes(last)) this.pending[this.pending.length - 1] = operation;
      else this.pending.push(operation);
    }

    change(name, value, control) {
      const spec = this.about.controls.find((c) => c.name === name);
      if (spec.kind !== "button") this.values[name] = value;
      this.push(["set", name, value],
        (last) => last[0] === "set" && last[1] === name && spec.kind === "range");
      if (this.mode !== "live") this.touch(undefined, control);
    }

    hold(name, x, y, touch, at) {
      this.push(["hold", name, x, y, touch],
        (last) => last[0] === "hold" && last[1] === name && last[4] === "drag" && touch === "drag");
      if (this.mode !== "live") this.touch(undefined, this.canvas, at);
    }

    /* Remember what was done at which tick, so that a link can repeat it. What restarts a run also
       starts its history. */
    note([kind, ...what]) {
      const spec = kind === "set" && this.about.controls.find((c) => c.name === what[0]);
      if (kind === "reset" || kind === "compare" || (spec && !spec.live)) {
        this.history = [];
        this.initial = { ...this.values };
        this.ticks = 0;
      } else if (kind === "set" || kind === "hold" || kind === "other") {
        this.trim();
        this.history.push([this.tick, kind, ...what]);
      }
    }

    /* The tick at which the next deed counts: one that has begun ends first. */
    get tick() { return this.ticks + (this.mode === "live" && this.report?.begun ? 1 : 0); }

    /* After a way back something new happens: what was done later is no longer part of the run. */
    trim() { this.history = this.history.filter(([tick]) => tick <= this.tick); }

    keydown(e) {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      const stop = () => { e.preventDefault(); e.stopPropagation(); };
      if (this.hand?.key(e)) return stop();
      for (const c of this.about.controls) {
        if (!c.keys || !(e.key in c.keys)) continue;
        stop();
        if (e.repeat) return;
        if (c.kind === "range") this.keysHeld = { ...(this.keysHeld || {}), [c.name]: c };
        if (!this.playing && c.kind === "range") this.setPlaying(true);
        this.change(c.name, c.keys[e.key], this.canvas);
        return;
      }
      const act = { " ": () => this.setPlaying(!this.playing),
        ".": () => this.film || this.nextPhase(this.canvas),
        r: () => this.film || this.restart(this.seed, this.canvas) }[e.key];
      if (!act) return;
      stop();
      if (!e.repeat) act();
    }

    keyup(e) {
      for (const c of Object.values(this.keysHeld || {})) {
        if (e.key in c.keys) {
          delete this.keysHeld[c.name];
          this.change(c.name, 0, this.canvas);
        }
      }
      if (this.keysHeld && !Object.keys(this.keysHeld).length) this.keysHeld = null;
    }

    release() {
      this.hand?.letGo("cancel");
      for (const c of Object.values(this.keysHeld || {})) this.change(c.name, 0, this.canvas);
      this.keysHeld = null;
    }

    /* ---- two worlds, a hundred seeds -------------------------------------------------------- */
    async compare(name) {
      const old = this.compared && this.inputs[this.compared.name];
      old?.other.remove();
      this.compareSelect.value = name;
      const spec = this.about.controls.find((c) => c.name === name);
      const value = spec ? PF.contrast(spec, this.values[name]) : null;
      this.compared = spec ? { name, value } : null;
      this.root.classList.toggle("pf-two", Boolean(spec));
      if (spec) {
        const id = `pf-${this.key}-${name}-other`;
        const { node } = PF.control({ ...spec, help: "" }, id, value, (v) => this.changeOther(v),
          ", right");
        node.classList.add("pf-other");
        this.inputs[name].other = node;
        this.inputs[name].node.after(node);
        node.closest("details")?.setAttribute("open", "");
      }
      await this.touch(undefined, this.compareSelect);
      if (this.mode !== "live") return;
      this.pending.push(["compare", spec ? name : null, value]);
      this.setPlaying(true);
      this.fit();
      this.say(spec ? `Two worlds of one seed. They differ in: ${spec.label}.` : "One world again.");
    }

    changeOther(value) {
      this.compared.value = value;
      this.push(["other", value], (last) => last[0] === "other");
    }

    async runMany(control) {
      await this.touch(undefined, control);
      if (this.mode !== "live") return;
      this.many.begin(this.renderer.dark);
      this.say("A hundred seeds run behind the picture.");
    }

    /* ---- live ----------------------------------------------------------------------------- */
    /* control: what the reader pressed, which then shows the progress; at: where in the picture */
    async touch(fromTick, control, at = null) {
      if (this.mode === "live" || this.film) return;
      control = control || (this.liveButton.hidden ? this.transport.play : this.liveButton);
      this.starting = this.starting
        || this.goLive(fromTick, control, at).finally(() => { this.starting = null; });
      return this.starting;
    }

    async goLive(fromTick, control, at) {
      this.liveButton.disabled = true;
      this.status.setAttribute("aria-live", "polite");
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
      const state = { id: this.o.id, seed: this.seed, n: this.tick, v: {}, h: this.history };
      for (const [k, v] of Object.entries(this.initial)) if (this.inputs[k]) state.v[k] = v;
      let text = JSON.stringify(state);
      const whole = text.length <= 6000 && !this.compared;
      if (!whole) text = JSON.stringify({ ...state, h: [], n: 0 });
      history.replaceState(null, "", "#run=" + encodeURIComponent(text));
      this.say(whole ? "The address of this page now names this exact run: copy it."
        : this.compared ? "The address now names the left world's seed and controls."
          : "Too many moves for a link: the address now names the seed and controls only.");
    }

    /* State from an address is data: known names, checked kinds, bounded numbers, or it is ignored.
       Python checks every value once more. */
    open(state) {
      const spec = (name) => this.about.controls.find((c) => c.name === name);
      const fits = (c, v) => c && (
        (c.kind === "range" && typeof v === "number" && Number.isFinite(v))
        || (c.kind === "toggle" && typeof v === "boolean") || (c.kind === "button" && v === true)
        || (c.kind === "choice" && c.choices.some(([k]) => k === v)));
      const done = {
        set: (name, value, ...rest) => !rest.length && spec(name)?.live && fits(spec(name), value),
        hold: (name, x, y, touch, ...rest) => !rest.length && typeof name === "string"
          && name.length <= 40 && [x, y].every(Number.isFinite) && PF.TOUCHES.includes(touch),
      };
      if (Number.isInteger(state.seed) && state.seed >= 0 && state.seed < 2147483648) {
        this.seed = state.seed;
        this.seedInput.value = state.seed;
      }
      const n = Number.isInteger(state.n) ? Math.max(0, Math.min(MOST_REPLAY, state.n)) : 0;
      for (const [name, value] of Object.entries(state.v && typeof state.v === "object" ? state.v : {})) {
        if (!fits(spec(name), value) || spec(name).kind === "button") continue;
        this.values[name] = this.initial[name] = value;
        this.inputs[name]?.write(value);
      }
      const start = [];
      let tick = 0;
      for (const entry of Array.isArray(state.h) ? state.h.slice(0, 400) : []) {
        if (!Array.isArray(entry)) continue;
        const [when, kind, ...what] = entry;
        if (!Number.isInteger(when) || when < tick || when > n) continue;
        if (!Object.hasOwn(done, kind) || !done[kind](...what)) continue;
        if (when > tick) start.push(["step", when - tick]);
        tick = when;
        start.push([kind, ...what]);
        this.history.push(entry);
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
