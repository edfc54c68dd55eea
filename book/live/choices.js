/* An answer that is a letter: radio buttons that write the code of the answer, and read it. The
   code stays what is kept. A prediction also asks how sure the reader is. */
(function (PF) {
  "use strict";

  const el = PF.el;
  const PER_CENT = "How sure you are is a number from 0 to 100 per cent, such as 70.";

  PF.Choices = class {
    /* item; choose: { name, options, sure }; write(code) is called when the reader chooses. */
    constructor(item, { name, options, sure }, write) {
      this.name = name;
      const changed = () => { this.complain(""); write(this.code()); };
      this.radios = options.map(([letter]) => el("input", { type: "radio", value: letter,
        name: `pf-choice-${item}`, onchange: changed }));
      const id = `pf-sure-${item}`;
      this.problem = el("span", { class: "pf-problem-text", id: id + "-problem" });
      this.sure = sure && el("input", { type: "number", min: 0, max: 100, step: "any", id,
        inputmode: "numeric", "aria-describedby": id + "-problem", onchange: changed });
      this.root = el("fieldset", { class: "pf-choices" },
        el("legend", { class: "pf-sr" }, sure ? "Your prediction" : "Your answer"),
        ...options.map(([letter, text], k) =>
          el("label", {}, this.radios[k], el("span", {}, `(${letter}) ${text}`))),
        sure ? el("p", { class: "pf-sure" }, el("label", { for: id }, "How sure are you? "),
          this.sure, " %", this.problem) : null);
    }

    code() {
      const radio = this.radios.find((r) => r.checked);
      const letter = radio ? `"${radio.value}"` : "...";
      const sure = this.sure && this.sure.value;
      return `${this.name} = ` + (sure ? `(${letter}, ${sure})` : letter);
    }

    /* Show what the code says; false if that is no letter of ours. */
    read(text) {
      const found = text.replace(/#.*$/gm, "").match(
        /^\s*(\w+)\s*=\s*(?:\(\s*)?(?:["']([a-z])["']|\.\.\.)\s*(?:,\s*(-?\d+(?:\.\d+)?)\s*)?\)?\s*$/);
      this.readable = Boolean(found && found[1] === this.name);
      this.show(this.readable ? found[2] : null, this.readable ? found[3] : null);
      return this.readable;
    }

    show(letter, sure) {
      for (const r of this.radios) r.checked = r.value === letter;
      if (!this.sure || document.activeElement === this.sure) return;
      if (sure != null || !this.sure.validity.badInput) this.sure.value = sure ?? "";
    }

    /* Why a prediction cannot be locked yet, in a sentence; "" if it can. The lab itself has the
       same rules; here the field at fault gets the focus. */
    refusal() {
      if (!this.sure || !this.readable) return "";
      if (!this.radios.some((r) => r.checked)) {
        this.radios[0].focus();
        return "Choose one first.";
      }
      const value = this.sure.valueAsNumber;
      let why = "";
      if (this.sure.validity.badInput) why = PER_CENT;
      else if (!Number.isFinite(value)) why = "First say how sure you are: a locked prediction stays.";
      else if (value < 0 || value > 100) why = `${PER_CENT} ${this.sure.value} is not.`;
      else if (value > 0 && value <= 1) why = `${PER_CENT} Write 70, not 0.7.`;
      this.complain(why);
      if (why) this.sure.focus();
      return why;
    }

    complain(why) {
      if (!this.sure) return;
      this.problem.textContent = why;
      if (why) this.sure.setAttribute("aria-invalid", "true");
      else this.sure.removeAttribute("aria-invalid");
    }

    lock({ choice, sure }) {
      this.complain("");
      this.show(choice, sure);
      this.root.disabled = true;
    }
  };
})((globalThis.PF = globalThis.PF || {}));
