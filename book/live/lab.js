/* Lab cells in the page: each answer cell of the notebook becomes an editor, the check cell after
   it its Check button. Loaded by pages with answer cells only; needs page.js, store.js, choices.js.
   Everything that a reader types or imports is text: it is shown with textContent and run by
   Python in a worker of its own, when the reader asks for it. */
(function (PF) {
  "use strict";

  const el = PF.el;
  const BIGGEST = 2e6; // characters of a file to import
  const LONGEST = 100000; // characters of one imported answer
  const ROOM = 5e8; // bytes: a Python that holds more is ended after the run
  let lab, limit, store, python, editors = [], bar, busy = null, predictions = {}, refused = false, who, review;

  /* ---- a file of answers ------------------------------------------------------------------ */
  function exportAnswers() {
    const answers = {};
    for (const e of editors) {
      if (e.text !== e.cell.source) answers[e.cell.item] = { source: e.text, version: e.cell.version };
    }
    const data = { schema: 1, lab: lab.lab, answers, predictions };
    const ticks = store.ticks(), student = PF.studentOf(store.student());
    if (Object.keys(ticks).length) data.ticks = ticks;
    if (student) data.student = student;
    const again = review.state();
    if (again.off || Object.keys(again.items).length) data.review = again;
    const blob = new Blob([JSON.stringify(data, null, 1) + "\n"], { type: "application/json" });
    const link = el("a", { href: URL.createObjectURL(blob), download: `${lab.lab}_answers.json` });
    document.body.append(link);
    link.click();
    link.remove();
    return `Exported ${Object.keys(answers).length} answers to ${lab.lab}_answers.json.`;
  }

  /* An imported file is data: strings go into editors, where nothing runs until the reader says so. */
  function importAnswers(text) {
    let data;
    try {
      if (text.length > BIGGEST) throw new Error(`it is larger than ${BIGGEST / 1e6} megabytes`);
      data = JSON.parse(text);
      if (!data || typeof data !== "object" || data.schema !== 1) throw new Error("its schema is not 1");
      if (![lab.lab, lab.former].includes(data.lab)) throw new Error("it belongs to another lab");
      if (!data.answers || typeof data.answers !== "object") throw new Error("it holds no answers");
    } catch (error) {
      return `Nothing was imported: ${String(error.message).slice(0, 120)}.`;
    }
    let n = 0, old = 0;
    adopt(data.predictions);
    adoptTicks(data.ticks);
    if (Object.keys(predictions).length) editors[0].isKept(store.writePredictions(predictions));
    for (const e of editors) {
      const entry = Object.hasOwn(data.answers, e.cell.item) ? data.answers[e.cell.item] : null;
      if (!entry || typeof entry.source !== "string" || entry.source.length > LONGEST) continue;
      e.editor.set(asCell(e.cell, entry.source));
      n++;
      if (entry.version !== e.cell.version) old++;
    }
    const student = PF.studentOf(data.student);
    if (student) who.show(student, `The file answers the questions of ${student.who}: use the id to get them.`);
    return `Imported ${n} answers.` + (old ? ` ${old} of them answer an earlier version of a question.` : "");
  }

  /* The notebook's own file keeps the value of a short answer; the page needs the whole cell. */
  function asCell(cell, source) {
    const name = cell.source.match(/^\s*(\w+)\s*=/);
    const isStatement = /^\s*(def|class|import|from|@|#|"""|'''|\w+\s*=[^=])/m.test(source);
    return name && !isStatement ? `${name[1]} = ${source}` : source;
  }

  /* ---- predictions: locked by the lab itself; the page keeps what it says, and gives it back -- */
  /* Predictions of a file or of another tab: a letter that exists, for what is still open. */
  function adopt(found) {
    for (const e of editors) {
      const kept = found && typeof found === "object" && Object.hasOwn(found, e.cell.item)
        ? found[e.cell.item] : null;
      const options = e.cell.choose ? e.cell.choose.options : [];
      if (!kept || predictions[e.cell.item] || !options.some(([k]) => k === kept.choice)) continue;
      const sure = Number.isFinite(kept.sure) ? kept.sure : null;
      predictions[e.cell.item] = { choice: kept.choice, sure, version: String(kept.version) };
      python.told = false; // Python must hear of it before it runs the next cell
    }
    showLocks();
  }

  function showLocks() {
    for (const e of editors) {
      if (e.choices && predictions[e.cell.item]) e.lock(predictions[e.cell.item]);
    }
  }

  /* Ticks of a file, for rubrics that this page has: whole numbers of their lines. */
  function adoptTicks(found) {
    for (const e of editors) {
      const lines = e.rubric && found && typeof found === "object" && Object.hasOwn(found, e.cell.item)
        ? found[e.cell.item] : null;
      if (!Array.isArray(lines)) continue;
      e.isKept(store.writeTicks(e.cell.item, lines.filter((k) => e.cell.rubric[k - 1] !== undefined)));
    }
    showTicks();
  }

  function showTicks() {
    const ticks = store.ticks();
    for (const e of editors) {
      if (e.rubric && Array.isArray(ticks[e.cell.item])) e.rubric.show(ticks[e.cell.item]);
    }
  }

  /* ---- whose questions ---------------------------------------------------------------------- */
  /* Ask a student's questions, null for those in print; how many differ from those. */
  async function enter(student) {
    if (busy) throw new Error("an answer is still running");
    const told = await python.ask({ do: "student", lab: lab.lab, who: "", term: "", ...student });
    const asked = JSON.parse(told);
    for (const e of editors) if ((asked[e.cell.item] || "") !== e.own) e.askAnew();
    editors[0].isKept(store.writeStudent(student && { ...student, asked }));
    await tellPython();
    return showQuestions();
  }

  /* The questions of one's own that the store holds, above their answers; how many there are. */
  function showQuestions() {
    const asked = store.student().asked || {};
    for (const e of editors) e.showQuestion(Object.hasOwn(asked, e.cell.item) ? String(asked[e.cell.item]) : "");
    return editors.filter((e) => e.own).length;
  }

  /* Python, started if need be, that knows what the reader locked and whose questions these are. */
  async function informed() {
    const starts = !python.worker;
    await python.start();
    if (starts || !python.told) await tellPython();
  }

  async function tellPython() {
    python.told = true;
    const student = PF.studentOf(store.student());
    if (!Object.keys(predictions).length && !student) return;
    const text = JSON.stringify({ schema: 1, lab: lab.lab, answers: {}, predictions, student });
    await python.ask({ do: "restore", lab: lab.lab, text });
  }

  async function hearPython(answer) {
    const text = await python.ask({ do: "progress", lab: lab.lab });
    if (!text) return;
    // A lock stays: a Python that was stopped and started anew may not know it yet.
    const told = JSON.parse(text);
    predictions = { ...predictions, ...told.predictions };
    for (const [item, lines] of Object.entries(told.ticks || {})) store.writeTicks(item, lines);
    showTicks();
    showLocks();
    if (Object.keys(predictions).length) answer.isKept(store.writePredictions(predictions));
  }

  /* The list of options above the answer, if the controls repeat it word for word. */
  function repeated(list, options) {
    if (!list || list.tagName !== "UL") return false;
    const plain = (text) => text.replace(/\s+/g, " ").trim();
    return [...list.children].map((li) => plain(li.textContent)).join("\n")
      === options.map(([letter, text]) => plain(`(${letter}) ${text}`)).join("\n");
  }

  const button = (label, onclick, more) => el("button", { type: "button", onclick, ...more }, label);

  /* ---- one answer cell -------------------------------------------------------------------- */
  class Answer {
    constructor(cell, check, node, checkNode) {
      this.cell = cell;
      this.check = check;
      this.build();
      const list = node.previousElementSibling;
      if (cell.choose && repeated(list, cell.choose.options)) list.hidden = true;
      node.replaceWith(this.root);
      if (checkNode) checkNode.remove();
      this.text = this.base = cell.source; // base: the text that the store and this tab agree on
      const saved = store.read(cell.item);
      if (saved && saved.version === cell.version) {
        this.text = this.base = saved.source;
        this.judged = saved.judged && { ...saved.judged, earlier: true };
        this.hints = Number(saved.hints) || 0;
        if (saved.source !== cell.source) this.note.textContent = "Your saved answer.";
      } else if (saved && store.write(cell.item + "/old", saved)) store.remove(cell.item);
      this.makeEditor();
      this.offerOld();
      this.offerAside(store.read(cell.item + "/aside"));
      if (this.choices) this.reflect();
      this.showVerdict();
    }

    build() {
      const { cell, check } = this;
      this.editorBox = el("div", { class: "pf-editor", tabindex: "-1" });
      this.verdict = el("span", { class: "pf-verdict" });
      this.note = el("p", { class: "pf-note", role: "status", "aria-live": "polite" });
      this.clock = el("span", { class: "pf-clock" }); // changes often: seen, not announced
      this.warning = el("div", { class: "pf-row pf-warning", role: "status", hidden: true });
      this.offer = el("div", { class: "pf-row pf-offer", hidden: true });
      this.conflict = el("div", { class: "pf-row pf-conflict", role: "status", hidden: true });
      this.out = el("pre", { class: "pf-out", tabindex: "0", hidden: true,
        "aria-label": `Output of ${cell.item}` });
      this.runButton = button("Run", () => this.run(false), { title: "Shift+Enter" });
      this.checkButton = button("Check", () => this.run(true),
        { class: "pf-check", hidden: !check, title: "Ctrl+Enter" });
      this.stopButton = button("Stop", () => this.stop("Stopped by you."), { class: "pf-stop", hidden: true });
      this.againButton = button("Try again", () => this.run(this.checking), { hidden: true });
      this.resetButton = button("Reset", () => {
        this.editor.set(cell.source);
        this.note.textContent = "Reset." + (cell.choose ? "" : " Undo brings your answer back.");
      }, { title: "Back to the empty answer" });
      let code = this.editorBox;
      if (cell.choose) {
        this.choices = new PF.Choices(cell.item, cell.choose, (text) => this.editor.set(text));
        this.checkButton.textContent = cell.choose.sure ? "Lock prediction" : "Check";
        code = this.disclosure = el("details", { class: "pf-code", ontoggle: () => this.arrange() },
          el("summary", {}, "Show code"), this.editorBox);
      }
      this.question = el("p", { class: "pf-own", hidden: true });
      if (cell.rubric) {
        this.rubric = new PF.Rubric(cell.item, cell.rubric,
          (lines) => this.isKept(store.writeTicks(cell.item, lines)));
      }
      if (cell.worked) {
        this.worked = new PF.Worked(cell.item, async () => {
          await informed();
          return python.ask({ do: "solution", lab: lab.lab, item: cell.item });
        });
      }
      this.hints = 0;
      this.root = el("div", { class: "pf-answer", role: "group", "aria-label": `Answer ${cell.item}` },
        el("div", { class: "pf-row" }, el("span", { class: "pf-name" }, cell.item), this.verdict,
          this.note, this.clock),
        this.question, this.offer, this.conflict, this.choices ? this.choices.root : null, code, this.warning,
        this.buttons = el("div", { class: "pf-row" }, this.runButton, this.checkButton,
          this.resetButton, this.stopButton, this.againButton),
        this.out, this.rubric && this.rubric.root, this.worked && this.worked.root);
    }

    makeEditor() {
      this.editor = window.PFEditor(this.editorBox, {
        doc: this.text, label: `Code of answer ${this.cell.item}; Escape leaves the editor`,
        dark: PF.isDark(this.root),
        onRun: () => this.run(false), onCheck: () => this.run(Boolean(this.check)),
        onLeave: () => this.runButton.focus(),
        onChange: (text) => {
          this.text = text;
          if (this.choices) this.reflect();
          this.showVerdict();
          clearTimeout(this.saving);
          this.saving = setTimeout(() => this.save(), limit.pause);
        },
      });
    }

    /* The controls follow the code; code that they cannot show is opened. */
    reflect() {
      if (!this.locked && !this.choices.read(this.text)) this.disclosure.open = true;
      this.arrange();
    }

    /* Who chooses by radio button needs Run only beside the code, and nothing once it is locked. */
    arrange() {
      const shown = this.disclosure.open;
      this.runButton.hidden = !shown;
      this.checkButton.hidden = !this.check || (this.locked && !shown);
      this.resetButton.hidden = Boolean(this.locked);
      this.buttons.hidden = Boolean(this.locked) && !shown;
    }

    lock(kept) {
      if (this.locked) return;
      this.locked = kept;
      this.choices.lock(kept);
      this.arrange();
      this.showVerdict();
    }

    /* The last verdict, for as long as it is about the text that stands here. */
    showVerdict() {
      const { judged, root } = this;
      if (this.locked) {
        const sure = this.locked.sure == null ? "" : `, ${Math.round(this.locked.sure)} % sure`;
        this.verdict.textContent = `Locked: (${this.locked.choice})${sure}.`;
        root.dataset.status = "predicted";
        root.removeAttribute("data-stale");
        return;
      }
      const edited = judged && judged.source !== this.text;
      if (this.rubric) this.rubric.root.hidden = !judged || judged.status !== "recorded";
      if (this.worked) this.worked.root.hidden = !PF.maySee(judged, this.hints);
      this.verdict.textContent = judged
        ? (judged.earlier ? "earlier: " : "") + judged.told + (edited ? ", edited since" : "") : "";
      root.dataset.status = judged ? judged.status : "";
      root.toggleAttribute("data-stale", Boolean(edited));
    }

    /* The question with the reader's own numbers; "" where those in print stand. */
    showQuestion(text) {
      this.own = text;
      this.question.hidden = !text;
      this.question.textContent = text && `Your question: ${text}`;
    }

    /* Other numbers: what was judged, and the worked answer, were about the old ones. */
    askAnew() {
      this.judged = undefined;
      this.hints = 0;
      if (this.worked) this.worked.filled = this.worked.root.open = false;
      this.showVerdict();
      if (this.stored() === this.text) this.save(true);
    }

    /* ---- keeping ---- */
    /* Only what was edited, or judged, is kept, and never over a text that this tab has not seen. */
    save(judged = false) {
      clearTimeout(this.saving);
      if (this.text === this.base && !judged) return;
      const { text: source, judged: verdict, hints } = this;
      const record = { source, version: this.cell.version, judged: verdict, hints };
      const there = this.stored();
      if (this.other || (there !== this.base && there !== this.text)) {
        this.isKept(store.write(this.cell.item + "/aside", record));
        if (!this.other) this.offerOther(there);
      } else if (this.isKept(store.write(this.cell.item, record))) this.base = this.text;
    }

    /* The text in the store; the text agreed on if there is none. */
    stored() {
      const record = store.read(this.cell.item);
      return record && record.version === this.cell.version ? record.source : this.base;
    }

    /* Another tab wrote: an unedited editor follows, an edited one keeps its own text. */
    follow(record) {
      if (!record || record.version !== this.cell.version) return;
      if (record.source !== this.text && (this.text !== this.base || this.other)) {
        this.offerOther(record.source);
        return;
      }
      const news = record.source !== this.text;
      this.base = record.source;
      this.judged = record.judged && { ...record.judged, earlier: true };
      this.hints = Number(record.hints) || 0;
      if (news) {
        this.editor.set(record.source);
        this.note.textContent = "This is what you typed in another tab.";
      }
      this.showVerdict();
    }

    offerOther(source) {
      const first = !this.other;
      this.other = { source };
      if (first) this.save();
      this.choose("This answer was changed in another tab, too. Both versions are kept: yours stands here.",
        source);
    }

    offerAside(record) {
      if (!record || record.version !== this.cell.version) return;
      if (record.source === this.text) store.remove(this.cell.item + "/aside");
      else this.choose("Two tabs had changed this answer. The other version is kept, too.", record.source);
    }

    choose(told, source) {
      const done = (take) => () => {
        this.other = null;
        this.base = this.stored();
        store.remove(this.cell.item + "/aside");
        this.conflict.hidden = true;
        if (take) this.editor.set(source);
        this.save();
        this.editor.focus();
      };
      this.conflict.hidden = false;
      this.conflict.replaceChildren(el("p", { class: "pf-note" }, told),
        el("details", {}, el("summary", {}, "Show the other version"), el("pre", {}, source)),
        button("Keep this one", done(false)), button("Take the other", done(true)));
    }

    offerOld() {
      const old = store.read(this.cell.item + "/old");
      if (!old || old.declined) return;
      const done = (take) => () => {
        store.write(this.cell.item + "/old", { ...old, declined: true });
        this.offer.hidden = true;
        if (take) this.editor.set(old.source);
      };
      this.offer.hidden = false;
      this.offer.replaceChildren(
        el("span", { class: "pf-note" }, "The question has changed since you answered. Your earlier answer is kept."),
        button("Use it", done(true)), button("Keep the new question", done(false)));
    }

    /* Say once, beside the editor at hand, that the browser keeps nothing. */
    isKept(worked) {
      if (worked && refused) editors.forEach((e) => { e.warning.hidden = true; });
      if (!worked && this.warning.hidden) {
        editors.forEach((e) => { e.warning.hidden = true; });
        this.warning.hidden = false;
        this.warning.replaceChildren(
          el("p", { class: "pf-note" }, "This browser does not let the page keep your answers "
            + "(storage is refused or full). They stay until you leave: export them."),
          button("Export answers", () => { this.note.textContent = exportAnswers(); }));
      }
      refused = !worked;
      return worked;
    }

    /* ---- running ---- */
    async run(check) {
      if (busy) {
        this.note.textContent = `${busy === this ? "This" : "Another"} answer is still running.`;
        return;
      }
      const refusal = check && this.choices && !this.locked ? this.choices.refusal() : "";
      if (refusal) {
        this.note.textContent = refusal;
        return;
      }
      busy = this;
      this.checking = check;
      this.save();
      const source = this.text, began = performance.now();
      const pressed = check ? this.checkButton : this.runButton;
      pressed.setAttribute("aria-busy", "true");
      this.runButton.disabled = this.checkButton.disabled = true;
      this.stopButton.hidden = false;
      this.againButton.hidden = true;
      this.stopped = "";
      try {
        await this.boot();
        this.note.textContent = "Running.";
        const report = await this.timed(this.ask(check ? this.check.index : this.cell.index));
        this.show(report);
        if (check) {
          const told = report.headline.slice(this.cell.item.length + 2);
          this.judged = { source, status: report.status, told: told || "could not be judged" };
          if (report.status === "passed") review.enlist(this.cell.item);
          if (["wrong", "partial"].includes(report.status)) this.hints++;
          this.save(true);
        }
        this.showVerdict();
        await hearPython(this);
        this.tell(report, check, (performance.now() - began) / 1000);
        await this.giveBack();
      } catch (error) {
        python.told = false;
        python.stop();
        this.show({ text: "", error: this.stopped || this.breakdown(String(error.message || error)), note: "" });
        this.note.textContent = this.out.textContent;
      } finally {
        this.clock.textContent = "";
        pressed.removeAttribute("aria-busy");
        this.runButton.disabled = this.checkButton.disabled = false;
        this.stopButton.hidden = true;
        busy = null;
      }
    }

    /* Python is loaded once a visit. How far it is, is shown; that it began, is said. */
    async boot() {
      const starts = !python.worker;
      if (starts) this.note.textContent = "Starting Python.";
      const progress = (text) => { this.clock.textContent = text; };
      python.onProgress(progress);
      try {
        await python.start();
      } catch (error) {
        this.againButton.hidden = Boolean(this.stopped);
        throw new Error(`Python could not be loaded: ${error.message || error}`);
      } finally {
        python.listeners.delete(progress);
        this.clock.textContent = "";
      }
      if (starts || !python.told) await tellPython();
    }

    async ask(index) {
      const cells = lab.cells.map((c) => {
        const e = editors.find((x) => x.cell.index === c.index);
        return { index: c.index, kind: c.kind, item: c.item ?? `cell ${c.index}`,
          source: e ? e.text : c.source, stub: e ? c.source : "" };
      });
      return JSON.parse(await python.ask({ do: "cell", cells: JSON.stringify(cells), index }));
    }

    /* Wait, show the time that is left, and end a cell that takes too long. */
    async timed(answer) {
      const end = performance.now() + 1000 * limit.seconds;
      const clock = setInterval(() => {
        const left = Math.ceil((end - performance.now()) / 1000);
        if (left <= 0) this.stop(`Stopped after ${limit.seconds} s: does a loop never end?`);
        else if (left < limit.seconds - 1) this.clock.textContent = `stopped in ${left} s`;
      }, 250);
      try {
        return await answer;
      } finally {
        clearInterval(clock);
      }
    }

    stop(reason) {
      this.stopped = reason;
      python.stop();
    }

    /* Python itself broke: recursion or memory beyond what WebAssembly bears. */
    breakdown(told) {
      if (/could not be loaded|was built without/.test(told)) return told;
      const why = /stack|recursion|out of bounds/i.test(told) ? "The cell calls itself too deeply"
        : /memory|alloc/i.test(told) ? "The cell used up the memory of the page"
          : `Python broke down (${told.slice(0, 120)})`;
      return `${why}. Python starts anew with your next run; your answers are kept.`;
    }

    /* Memory that Python once took it never gives back, so a Python that took much is ended. */
    async giveBack() {
      const bytes = await python.ask({ do: "memory" });
      if (bytes < ROOM) return;
      python.told = false;
      python.stop();
      this.note.textContent += ` It took ${Math.round(bytes / 1e6)} MB of memory, so Python starts anew with your next run.`;
    }

    tell({ error, before }, check, seconds) {
      const above = before.filter((i) => i !== this.cell.index).length;
      const what = error ? `An error: ${error.split("\n")[0].slice(0, 160).replace(/\.$/, "")}.`
        : check ? `Checked: ${this.judged.told}.` : "Ran.";
      this.note.textContent = `${what} ${seconds.toFixed(1)} s.`
        + (above ? ` Ran ${above} cell${above > 1 ? "s" : ""} above first.` : "");
    }

    show({ text, error, note }) {
      const gap = text && !text.endsWith("\n") ? "\n" : "";
      this.out.replaceChildren(text,
        error ? el("span", { class: "pf-error" }, gap + error) : "",
        note && note !== error ? el("span", { class: "pf-hint" }, (error ? "\n" : gap) + note) : "");
      this.out.hidden = !this.out.textContent;
    }
  }

  /* ---- the page --------------------------------------------------------------------------- */
  async function start() {
    const data = document.getElementById("pf-lab");
    if (!data) return;
    lab = JSON.parse(data.textContent);
    limit = { seconds: lab.seconds, pause: 300 }; // of a cell; ms without a key, to keep an answer
    store = new PF.Store(lab.lab);
    if (lab.former) store.bring(lab.former);
    python = new PF.Python("cells");
    await PF.loadScript("editor.js");
    const at = (cell) => document.querySelector(`.pf-cell-${cell.index}`);
    const answers = lab.cells.filter((c) => c.kind === "answer" && at(c));
    if (!answers.length) return;
    const note = el("span", { class: "pf-note", role: "status", "aria-live": "polite" });
    const file = el("input", { type: "file", accept: ".json,application/json", id: "pf-import",
      onchange: async () => {
        if (file.files[0]) note.textContent = importAnswers(await file.files[0].text());
        file.value = "";
      } });
    bar = el("div", { class: "pf-labbar", role: "group", "aria-label": "Your answers" },
      el("p", {}, "You can answer in this page. Python runs in your browser, nothing leaves it; "
        + `your answers are kept in this browser. A cell is stopped after ${lab.seconds} seconds.`),
      button("Export answers", () => { note.textContent = exportAnswers(); }),
      el("label", { for: "pf-import" }, "Import answers", file), note);
    who = new PF.Student(enter);
    for (const cell of answers) {
      const check = lab.cells.find((c) => c.kind === "check" && c.item === cell.item);
      const node = at(cell);
      editors.push(new Answer(cell, check, node, check && at(check)));
    }
    review = new PF.Review(lab.review,
      { read: () => store.review(), write: (x) => editors[0].isKept(store.writeReview(x)) },
      async (message) => { await informed(); return python.ask({ lab: lab.lab, ...message }); });
    editors[0].root.before(bar, who.root, review.root);
    for (const cell of lab.cells.filter((c) => c.kind === "solution" && at(c))) {
      if (editors.some((e) => e.worked && e.cell.item === cell.item)) at(cell).remove();
    }
    adopt(store.predictions());
    showTicks();
    showQuestions();
    who.show(PF.studentOf(store.student()));
    new MutationObserver(() => {
      for (const e of editors) e.editor.theme(PF.isDark(e.root));
    }).observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
    store.listen((name, text) => {
      if (name === "*predictions") adopt(store.predictions());
      if (name === "*ticks") showTicks();
      const one = editors.find((e) => e.cell.item === name);
      if (one) one.follow(PF.Store.record(text));
    });
    addEventListener("pagehide", () => editors.forEach((e) => e.save()));
    addEventListener("pageshow", ({ persisted }) => {
      if (persisted) editors.forEach((e) => e.follow(store.read(e.cell.item)));
    });
    // To look at, not to write: what stands in an editor comes from keys, a file or another tab.
    PF.lab = Object.freeze({ limit, text: (item) => editors.find((e) => e.cell.item === item).text });
  }
  start();
})((globalThis.PF = globalThis.PF || {}));
