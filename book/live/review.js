/* Review: problems that the reader solved come back at equal gaps, with other numbers, three at a
   time. It stands folded below the bar, only while something is due, and can be switched off. */
(function (PF) {
  "use strict";

  const el = PF.el;
  const DAY = 86400000;
  const dayOf = (time) => new Date(time).toISOString().slice(0, 10);

  PF.Review = class {
    /* rules: { gap, sitting, times, items } of the lab; kept: { read, write } of its dates;
       ask(message) sends a request to a Python that knows whose questions these are. */
    constructor(rules, kept, ask) {
      Object.assign(this, { rules, kept, ask });
      this.summary = el("summary", {});
      this.list = el("div", {});
      this.off = el("input", { type: "checkbox", id: "pf-review-off",
        onchange: () => this.save({ off: this.off.checked }) });
      this.root = el("details", { class: "pf-review", ontoggle: () => this.root.open && this.fill() },
        this.summary, this.list,
        el("p", {}, this.off, el("label", { for: "pf-review-off" }, " Do not offer reviews in this lab")));
      this.show();
    }

    /* { off, items: { item: { day, times } } }; what is not of this form is left out. */
    state() {
      const found = this.kept.read(), items = {};
      for (const item of this.rules.items) {
        const x = found.items && Object.hasOwn(found.items, item) ? found.items[item] : null;
        if (x && /^\d{4}-\d\d-\d\d$/.test(x.day) && Number.isInteger(x.times)) items[item] = x;
      }
      return { off: found.off === true, items };
    }

    save(change) { return this.kept.write({ ...this.state(), ...change }); }

    /* An item passed for the first time: it comes back after a gap. */
    enlist(item) {
      const { items } = this.state();
      if (!this.rules.items.includes(item) || items[item]) return;
      this.save({ items: { ...items, [item]: { day: dayOf(Date.now()), times: 0 } } });
    }

    due() {
      const { off, items } = this.state(), latest = dayOf(Date.now() - this.rules.gap * DAY);
      return off ? [] : Object.keys(items)
        .filter((i) => items[i].day <= latest && items[i].times < this.rules.times)
        .sort((a, b) => (items[a].day < items[b].day ? -1 : 1)).slice(0, this.rules.sitting);
    }

    /* Decided when the page opens: nothing appears while somebody reads. */
    show() {
      const n = this.due().length;
      this.root.hidden = !n;
      this.summary.textContent = `Review: ${n} problem${n > 1 ? "s" : ""} you solved, with other numbers`;
    }

    fill() {
      if (this.list.childElementCount) return;
      this.list.append(...this.due().map((item) => this.problem(item)));
    }

    problem(item) {
      const { times } = this.state().items[item], id = `pf-review-${item}`;
      const asked = el("p", { class: "pf-own" }, "Starting Python.");
      const answer = el("input", { type: "text", id, autocomplete: "off" });
      const told = el("p", { class: "pf-note", role: "status", "aria-live": "polite" });
      const send = async (event) => {
        event.preventDefault();
        told.textContent = "Checking.";
        told.textContent = await this.judge(item, times, answer.value);
      };
      this.ask({ do: "review", item, times }).then((text) => { asked.textContent = text; },
        (error) => { asked.textContent = `It cannot be asked: ${error.message || error}.`; });
      return el("form", { onsubmit: send, "aria-label": `Review ${item}` }, asked,
        el("label", { for: id }, "Your answer "), answer, el("button", { type: "submit" }, "Check"), told);
    }

    async judge(item, times, answer) {
      try {
        const [right, told] = JSON.parse(await this.ask({ do: "reviewed", item, times, answer }));
        if (!right) return told;
        const { items } = this.state();
        this.save({ items: { ...items, [item]: { day: dayOf(Date.now()), times: times + 1 } } });
        return `${told}. ${times + 1 < this.rules.times ? `It comes back in ${this.rules.gap} days.` : "It is done."}`;
      } catch (error) {
        return `It could not be judged: ${error.message || error}.`;
      }
    }
  };
})((globalThis.PF = globalThis.PF || {}));
