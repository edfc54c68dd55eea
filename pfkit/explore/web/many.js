/* A hundred seeds behind the picture: asks for a little work at a time and draws the histogram.
   A classic script; adds PF.Many. */
(function (PF) {
  "use strict";

  const SLICE = { beside: 6, alone: 40 }; // ms of Python at a time, while the picture moves or not

  PF.Many = class {
    /* ask(ticks, again) -> { drawing, report, ms }; say(sentence) */
    constructor(about, ask, say) {
      const el = PF.el;
      Object.assign(this, { ask, say });
      this.canvas = el("canvas", { class: "pf-canvas", role: "img",
        "aria-label": `Histogram of ${about.score} over 100 seeds` });
      this.words = el("p", {});
      this.stop = el("button", { type: "button", onclick: () => this.end() }, "Stop");
      this.root = el("div", { class: "pf-many", hidden: true }, this.canvas,
        el("div", { class: "pf-many-said" }, this.words, this.stop));
      this.running = false;
      this.ticks = 20;
    }

    begin(dark) {
      this.again = true;
      this.running = true;
      this.dark = dark;
      this.root.hidden = false;
      this.stop.hidden = false;
      this.done = -1;
      this.words.textContent = "";
    }

    end() {
      this.running = false;
      this.stop.hidden = true;
    }

    /* Called once a frame; asks when the last answer is there. */
    async work(moving) {
      if (!this.running || this.busy) return;
      this.busy = true;
      try {
        const { drawing, report, ms } = await this.ask(this.ticks, this.again);
        this.again = false;
        const goal = moving ? SLICE.beside : SLICE.alone;
        this.ticks = Math.max(1, Math.min(4000, Math.round((this.ticks * goal) / Math.max(ms, 0.5))));
        this.show(drawing, report);
      } catch (error) {
        this.end();
        this.words.textContent = "The seeds stopped: " + String(error.message || error).slice(0, 200);
      }
      this.busy = false;
    }

    show(drawing, report) {
      if (report.done === this.done) return;
      this.done = report.done;
      if (!this.renderer) this.renderer = new PF.Renderer(this.canvas, report.size);
      this.renderer.dark = this.dark;
      const width = Math.floor(this.root.clientWidth);
      if (width !== this.renderer.width) this.renderer.resize(width, 170);
      this.renderer.draw(drawing);
      this.words.textContent = report.sentence;
      if (report.done === report.runs) {
        this.end();
        this.say(report.sentence);
      }
    }

    theme(dark) {
      this.dark = dark;
      if (!this.renderer) return;
      this.renderer.dark = dark;
      if (this.renderer.last) this.renderer.draw(this.renderer.last);
    }
  };
})((globalThis.PF = globalThis.PF || {}));
