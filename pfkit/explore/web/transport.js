/* Time: play and pause, three speeds, and the last minute to scrub. A classic script; adds
   PF.Transport. */
(function (PF) {
  "use strict";

  const SPEEDS = [["1", "Full speed"], ["0.25", "Slowly"], ["phase", "By phase"]];
  const READING = 1800; // ms that a phase stands before the next begins
  const WINDOW = 2000; // ms over which the pace is judged
  const SLOW = 0.85; // of the pace it should have

  PF.Transport = class {
    /* rate: ticks a second; on: { play, phase, speed(pick), scrub(tick) } */
    constructor(id, rate, on, film) {
      const el = PF.el;
      this.rate = rate;
      this.pick = "1";
      this.rest = 0; // until when a phase stands
      this.play = el("button", { type: "button", class: "pf-play", onclick: on.play });
      this.phase = el("button", { type: "button", title: "On to the end of the next phase",
        onclick: (e) => on.phase(e.currentTarget) }, "Next phase");
      this.speeds = el("select", { "aria-label": "Speed", onchange: () => {
        this.pick = this.speeds.value;
        on.speed(this.pick, this.speeds);
      } }, ...SPEEDS.map(([value, label]) => el("option", { value }, label)));
      this.bar = el("input", { type: "range", min: 0, max: 0, value: 0, step: 1, id: id + "-time",
        "aria-label": "Time, the last minute", oninput: () => {
          this.showTime(+this.bar.value);
          if (!this.thumb.undecided) on.scrub(+this.bar.value, this.bar);
        } });
      this.thumb = new PF.Thumb(this.bar, () => on.scrub(+this.bar.value, this.bar),
        (old) => { this.bar.value = old; });
      this.time = el("output", { class: "pf-time", for: id + "-time" });
      this.late = el("p", { class: "pf-late", role: "status", hidden: true });
      const scrub = el("span", { class: "pf-scrub" }, this.bar, this.time);
      this.root = el("div", { class: "pf-transport" },
        ...(film ? [this.play, scrub] : [this.play, this.phase, this.speeds, scrub]));
    }

    get byPhase() { return this.pick === "phase"; }

    get speed() { return this.byPhase ? 1 : +this.pick; }

    playing(on) {
      this.play.textContent = on ? "Pause" : "Play";
      this.play.setAttribute("aria-pressed", String(on));
      this.began = 0;
    }

    /* Where the run is, and how far one can go back; a recorded run has an end. */
    show(tick, [first, last], recorded = false) {
      this.recorded = recorded;
      if (document.activeElement === this.bar && this.thumb.undecided) return;
      this.bar.min = first;
      this.bar.max = last;
      this.bar.value = tick;
      this.showTime(tick);
    }

    showTime(tick) {
      const ago = (+this.bar.max - tick) / this.rate, at = (tick / this.rate).toFixed(1);
      this.time.textContent = this.recorded ? `${at} of ${(+this.bar.max / this.rate).toFixed(0)}\u202fs`
        : ago < 0.05 ? `${at}\u202fs` : `${ago.toFixed(1)}\u202fs ago`;
      this.bar.setAttribute("aria-valuetext", this.time.textContent);
    }

    ended() { this.rest = performance.now() + READING; }

    get resting() { return this.byPhase && performance.now() < this.rest; }

    /* Say it when the machine cannot keep pace. */
    pace(ticks, ms) {
      const now = performance.now();
      if (!this.began || ticks < this.from || this.byPhase) { this.began = now; this.from = ticks; return; }
      const span = now - this.began;
      if (span < WINDOW) return;
      const share = (1000 * (ticks - this.from)) / (span * this.rate * this.speed);
      this.began = now;
      this.from = ticks;
      this.share = share;
      this.late.hidden = share > SLOW;
      if (share <= SLOW) {
        this.late.textContent = `Time runs at ${Math.round(100 * share)} % of its pace: `
          + `a step takes ${ms.toFixed(0)} ms on this machine.`;
      }
    }
  };
})((globalThis.PF = globalThis.PF || {}));
