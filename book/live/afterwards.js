/* What an answer offers once it was judged: the rubric of a text, to tick what holds of it, and the
   worked answer, folded. */
(function (PF) {
  "use strict";

  const el = PF.el;
  const HINTS = 3; // after which the worked answer may be seen, as in Jupyter
  const FINE = ["passed", "recorded", "predicted"];

  /* May the worked answer be seen? `judged` is the last verdict, `hints` how often one helped. */
  PF.maySee = (judged, hints) => FINE.includes(judged && judged.status) || hints >= HINTS;

  PF.Rubric = class {
    /* item; lines of the rubric; write(ticks) is called when the reader ticks. */
    constructor(item, lines, write) {
      const ticked = () => write(this.boxes.flatMap((b, k) => (b.checked ? [k + 1] : [])));
      this.boxes = lines.map(() => el("input", { type: "checkbox", onchange: ticked }));
      this.root = el("fieldset", { class: "pf-choices pf-rubric", hidden: true },
        el("legend", {}, `Tick what holds of ${item}; it is kept beside your answer`),
        ...lines.map((line, k) => el("label", {}, this.boxes[k], el("span", {}, line))));
    }

    show(ticks) {
      this.boxes.forEach((box, k) => { box.checked = ticks.includes(k + 1); });
    }
  };

  PF.Worked = class {
    /* fetch() gives the worked answer as text; it is asked for when the reader unfolds it. */
    constructor(item, fetch) {
      this.text = el("pre", { class: "pf-worked-text", tabindex: "0", "aria-label": `Worked answer of ${item}` });
      this.root = el("details", { class: "pf-worked", hidden: true, ontoggle: () => this.fill(fetch) },
        el("summary", {}, "Worked answer"), this.text);
    }

    async fill(fetch) {
      if (!this.root.open || this.filled) return;
      this.text.textContent = "Starting Python.";
      try {
        this.text.textContent = await fetch();
        this.filled = true;
      } catch (error) {
        this.text.textContent = `It cannot be shown: ${error.message || error}.`;
      }
    }
  };
})((globalThis.PF = globalThis.PF || {}));
