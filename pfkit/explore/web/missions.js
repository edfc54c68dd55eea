/* Guided missions and their ticks. A tick is the reader's: it stays when the run starts again, and is
   kept in this browser under the deed's name. A classic script; adds PF.Missions. */
(function (PF) {
  "use strict";

  PF.Missions = class {
    /* missions: [{ deed, text }]; key: names the scene and its panel; say: writes to a live region */
    constructor(missions, key, say) {
      const el = PF.el;
      this.key = `where-am-i/1/missions/${key}`;
      this.say = say;
      this.missions = missions.map(({ deed, text }, k) => {
        const mark = el("span", { class: "pf-mark", "aria-hidden": "true" }, String(k + 1));
        const word = el("span", { class: "pf-sr" });
        const row = el("li", {}, mark, word, el("div", {}, text));
        return { deed, mark, word, row, done: false };
      });
      this.root = el("div", { class: "pf-missions" }, el("p", { class: "pf-sub" }, "Try this"),
        el("ol", {}, ...this.missions.map((m) => m.row)));
      this.read();
      /* Another tab ticked one off. */
      this.follow = (e) => { if (e.key === this.key) this.read(); };
      addEventListener("storage", this.follow);
    }

    kept() {
      try {
        const deeds = JSON.parse(localStorage.getItem(this.key));
        return Array.isArray(deeds) ? deeds : [];
      } catch {
        return []; // nothing is kept, or the browser refuses: ticks last as long as the page
      }
    }

    read() {
      const kept = this.kept();
      for (const m of this.missions) if (kept.includes(m.deed)) this.tick(m);
    }

    tick(m) {
      m.done = true;
      m.row.classList.add("pf-done");
      m.mark.textContent = "\u2713";
      m.word.textContent = "Done: ";
    }

    /* done: for each mission, whether the scene has seen the deed */
    judge(done) {
      (done || []).forEach((seen, k) => {
        const m = this.missions[k];
        if (!seen || !m || m.done) return;
        this.tick(m);
        this.say(`Mission ${k + 1} done: ${m.deed}.`);
        const deeds = new Set([...this.kept(), ...this.missions.filter((x) => x.done).map((x) => x.deed)]);
        try { localStorage.setItem(this.key, JSON.stringify([...deeds])); } catch { /* see kept */ }
      });
    }

    destroy() { removeEventListener("storage", this.follow); }
  };
})((globalThis.PF = globalThis.PF || {}));
