/* Questions of one's own: an id, and a term, from which the lab draws other numbers and data. The
   same id gives the same numbers in Jupyter and to the grader. */
(function (PF) {
  "use strict";

  const el = PF.el;
  const LONGEST = 100; // characters of an id, as in the notebook's file

  /* { who, term } of what may lie in a file or in the store; null if that is no student. */
  PF.studentOf = function (found) {
    const text = (x) => (typeof x === "string" ? x.slice(0, LONGEST).trim() : "");
    return found && typeof found === "object" && text(found.who)
      ? { who: text(found.who), term: text(found.term) } : null;
  };

  PF.Student = class {
    /* enter({ who, term }) makes the lab ask that student's questions, null those in print. */
    constructor(enter) {
      this.who = el("input", { type: "text", id: "pf-who", maxlength: LONGEST, autocomplete: "off" });
      this.term = el("input", { type: "text", id: "pf-term", maxlength: LONGEST, size: 12 });
      this.note = el("span", { class: "pf-note", role: "status", "aria-live": "polite" });
      const form = el("form", { class: "pf-row", onsubmit: (event) => { event.preventDefault(); this.enter(enter); } },
        el("label", { for: "pf-who" }, "Your id ", this.who),
        el("label", { for: "pf-term" }, "Term, if your teacher names one ", this.term),
        el("button", { type: "submit" }, "Use it"));
      this.root = el("details", { class: "pf-student" },
        el("summary", {}, "Numbers of your own"),
        el("p", { class: "pf-note" }, "With an id some questions have other numbers, the same for you "
          + "here, in Jupyter and for the grader. An empty id gives those in print."),
        form, this.note);
    }

    /* What stands in the fields, and what is said of it. */
    show(student, told = student ? `The questions of ${student.who}.` : "") {
      this.who.value = student ? student.who : "";
      this.term.value = student ? student.term : "";
      this.note.textContent = told;
    }

    async enter(enter) {
      const student = PF.studentOf({ who: this.who.value, term: this.term.value });
      this.note.textContent = "Starting Python.";
      try {
        const n = await enter(student);
        this.note.textContent = student
          ? `The questions of ${student.who}: ${n} here have numbers of your own.` : "The questions as printed.";
      } catch (error) {
        this.note.textContent = `That did not work: ${error.message || error}.`;
      }
    }
  };
})((globalThis.PF = globalThis.PF || {}));
