/* Lab cells in the page: each answer cell of the notebook becomes an editor, the check cell after
   it its Check button. Loaded by pages with answer cells only; needs page.js. Everything that a
   reader types or imports is text: it is shown with textContent and run by Python in a worker of its
   own, when the reader asks for it. */
(function (PF) {
  "use strict";

  const el = PF.el;
  const LIMIT = { seconds: 30 }; // visible time after which a cell is stopped
  const BIGGEST = 2e6;
  let lab, python, editors = [], bar, busy = null, predictions = {}, memory = {};

  const keyOf = (item) => `where-am-i/1/${lab.lab}/${item}`;

  /* ---- keeping answers -------------------------------------------------------------------- */
  function keep(item, value) {
    memory[item] = value;
    try {
      localStorage.setItem(keyOf(item), JSON.stringify(value));
      return true;
    } catch {
      tell("This browser does not let the page keep your answers (storage is refused or full). "
        + "They stay until you leave: export them.");
      return false;
    }
  }

  function kept(item) {
    if (memory[item]) return memory[item];
    try {
      const value = JSON.parse(localStorage.getItem(keyOf(item)));
      return value && typeof value.source === "string" ? value : null;
    } catch {
      return null;
    }
  }

  function tell(text) { bar.note.textContent = text; }

  function answersNow() {
    const answers = {};
    for (const e of editors) {
      const source = e.get();
      if (source !== e.cell.source) answers[e.cell.item] = { source, version: e.cell.version };
    }
    return answers;
  }

  function exportAnswers() {
    const data = { schema: 1, lab: lab.lab, answers: answersNow(), predictions };
    const blob = new Blob([JSON.stringify(data, null, 1) + "\n"], { type: "application/json" });
    const link = el("a", { href: URL.createObjectURL(blob), download: `${lab.lab}_answers.json` });
    document.body.append(link);
    link.click();
    link.remove();
    tell(`Exported ${Object.keys(data.answers).length} answers to ${lab.lab}_answers.json.`);
    return data;
  }

  /* An imported file is data: strings go into editors, where nothing runs until the reader says so. */
  function importAnswers(text) {
    let data;
    try {
      if (text.length > BIGGEST) throw new Error("it is larger than two megabytes");
      data = JSON.parse(text);
      if (!data || typeof data !== "object" || data.schema !== 1) throw new Error("its schema is not 1");
      if (data.lab !== lab.lab) throw new Error("it belongs to another lab");
      if (!data.answers || typeof data.answers !== "object") throw new Error("it holds no answers");
    } catch (error) {
      tell(`Nothing was imported: ${String(error.message).slice(0, 120)}.`);
      return 0;
    }
    let n = 0, old = 0;
    adopt(data.predictions);
    for (const e of editors) {
      const entry = Object.prototype.hasOwnProperty.call(data.answers, e.cell.item)
        ? data.answers[e.cell.item] : null;
      if (!entry || typeof entry.source !== "string" || entry.source.length > 100000) continue;
      e.set(asCell(e.cell, entry.source));
      n++;
      if (entry.version !== e.cell.version) old++;
    }
    tell(`Imported ${n} answers.` + (old ? ` ${old} of them answer an earlier version of a question.` : ""));
    return n;
  }

  /* Predictions of a file or of the browser's store: a letter that exists, for what is still open. */
  function adopt(found) {
    for (const e of editors) {
      const kept = found && typeof found === "object"
        && Object.prototype.hasOwnProperty.call(found, e.cell.item) ? found[e.cell.item] : null;
      const options = e.cell.choose ? e.cell.choose.options : [];
      if (!kept || predictions[e.cell.item] || !options.some(([k]) => k === kept.choice)) continue;
      const sure = Number.isFinite(kept.sure) ? kept.sure : null;
      predictions[e.cell.item] = { choice: kept.choice, sure, version: String(kept.version) };
      python.told = false; // Python must hear of it before it runs the next cell
    }
    storePredictions();
    showLocks();
  }

  function showLocks() {
    for (const e of editors) {
      if (e.choices && predictions[e.cell.item]) e.lock(predictions[e.cell.item]);
    }
  }

  function storePredictions() {
    if (!Object.keys(predictions).length) return;
    try {
      localStorage.setItem(keyOf("*predictions"),
        JSON.stringify({ schema: 1, lab: lab.lab, answers: {}, predictions }));
    } catch { /* said when the answer was kept */ }
  }

  /* The notebook's own file keeps the value of a short answer; the page needs the whole cell. */
  function asCell(cell, source) {
    const name = cell.source.match(/^\s*(\w+)\s*=/);
    const isStatement = /^\s*(def|class|import|from|@|#|"""|'''|\w+\s*=[^=])/m.test(source);
    return name && !isStatement ? `${name[1]} = ${source}` : source;
  }

  /* ---- an answer that is a letter ---------------------------------------------------------- */
  /* Radio buttons that write the code of the answer, and read it: the code stays what is kept. */
  class Choices {
    constructor(answer) {
      const { name, options, sure } = answer.cell.choose;
      this.name = name;
      this.radios = options.map(([letter]) => el("input", { type: "radio", value: letter,
        name: `pf-choice-${answer.cell.item}`, onchange: () => answer.set(this.code()) }));
      this.sure = sure && el("input", { type: "number", min: 0, max: 100, step: 1,
        inputmode: "numeric", onchange: () => { this.tidySure(); answer.set(this.code()); } });
      this.root = el("fieldset", { class: "pf-choices" },
        el("legend", { class: "pf-sr" }, sure ? "Your prediction" : "Your answer"),
        ...options.map(([letter, text], k) =>
          el("label", {}, this.radios[k], el("span", {}, `(${letter}) ${text}`))),
        sure ? el("label", { class: "pf-sure" }, "How sure are you? ", this.sure, " %") : null);
    }

    tidySure() {
      const value = this.sure.valueAsNumber;
      this.sure.value = Number.isFinite(value) ? Math.min(100, Math.max(0, Math.round(value))) : "";
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
        /^\s*(\w+)\s*=\s*(?:\(\s*)?(?:["']([a-z])["']|\.\.\.)\s*(?:,\s*(\d+(?:\.\d+)?)\s*)?\)?\s*$/);
      const mine = found && found[1] === this.name;
      this.show(mine ? found[2] : null, mine ? found[3] : null);
      return Boolean(mine);
    }

    show(letter, sure) {
      for (const r of this.radios) r.checked = r.value === letter;
      if (this.sure && document.activeElement !== this.sure) this.sure.value = sure ?? "";
    }

    lock({ choice, sure }) {
      this.show(choice, sure);
      this.root.disabled = true;
    }
  }

  /* The list of options above the answer, if the controls repeat it word for word. */
  function repeated(list, options) {
    if (!list || list.tagName !== "UL") return false;
    const plain = (text) => text.replace(/\s+/g, " ").trim();
    return [...list.children].map((li) => plain(li.textContent)).join("\n")
      === options.map(([letter, text]) => plain(`(${letter}) ${text}`)).join("\n");
  }

  /* ---- one answer cell -------------------------------------------------------------------- */
  class Answer {
    constructor(cell, check, node, checkNode) {
      this.cell = cell;
      this.check = check;
      this.editorBox = el("div", { class: "pf-editor", tabindex: "-1" });
      this.note = el("p", { class: "pf-note", role: "status", "aria-live": "polite" });
      this.out = el("pre", { class: "pf-out", tabindex: "0", hidden: true,
        "aria-label": `Output of ${cell.item}` });
      this.runButton = el("button", { type: "button", title: "Shift+Enter",
        onclick: () => this.run(false) }, "Run");
      this.checkButton = el("button", { type: "button", class: "pf-check", hidden: !check,
        title: "Ctrl+Enter", onclick: () => this.run(true) }, "Check");
      this.stopButton = el("button", { type: "button", class: "pf-stop", hidden: true,
        onclick: () => this.stop("stopped by you") }, "Stop");
      const reset = el("button", { type: "button", title: "Back to the empty answer",
        onclick: () => {
          this.set(cell.source);
          this.note.textContent = "Reset." + (cell.choose ? "" : " Undo brings your answer back.");
        } }, "Reset");
      this.resetButton = reset;
      this.offer = el("div", { class: "pf-row", hidden: true });
      let code = this.editorBox;
      if (cell.choose) {
        this.choices = new Choices(this);
        this.checkButton.textContent = cell.choose.sure ? "Lock prediction" : "Check";
        code = this.disclosure = el("details", { class: "pf-code", ontoggle: () => this.arrange() },
          el("summary", {}, "Show code"), this.editorBox);
      }
      this.root = el("div", { class: "pf-answer", role: "group", "aria-label": `Answer ${cell.item}` },
        el("div", { class: "pf-row" }, el("span", { class: "pf-name" }, cell.item), this.note),
        this.offer, this.choices ? this.choices.root : null, code,
        this.buttons = el("div", { class: "pf-row" }, this.runButton, this.checkButton, reset,
          this.stopButton),
        this.out);
      const list = node.previousElementSibling;
      if (cell.choose && repeated(list, cell.choose.options)) list.hidden = true;
      node.replaceWith(this.root);
      if (checkNode) checkNode.remove();
      this.text = cell.source;
      const saved = kept(cell.item);
      if (saved && saved.version === cell.version) this.text = saved.source;
      else if (saved) this.offerOld(saved);
      this.makeEditor();
      if (this.choices) this.reflect();
      if (saved && saved.version === cell.version && saved.source !== cell.source) {
        this.note.textContent = "Your saved answer.";
      }
    }

    makeEditor() {
      const options = {
        doc: this.text, label: `Code of answer ${this.cell.item}; Escape leaves the editor`, dark: PF.isDark(this.root),
        onRun: () => this.run(false), onCheck: () => this.run(Boolean(this.check)),
        onLeave: () => this.runButton.focus(),
        onChange: (text) => {
          this.text = text;
          if (this.choices) this.reflect();
          clearTimeout(this.saving);
          this.saving = setTimeout(() => this.save(), 300);
        },
      };
      this.editor = window.PFEditor(this.editorBox, options);
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
      this.locked = kept;
      this.choices.lock(kept);
      this.root.dataset.status = "predicted";
      const sure = kept.sure == null ? "" : `, ${Math.round(kept.sure)} % sure`;
      this.note.textContent = `Locked: (${kept.choice})${sure}.`;
      this.arrange();
    }

    save() {
      clearTimeout(this.saving);
      if (this.text === this.cell.source && !kept(this.cell.item)) return;
      keep(this.cell.item, { source: this.text, version: this.cell.version });
    }

    offerOld(saved) {
      this.offer.hidden = false;
      this.offer.replaceChildren(
        el("span", { class: "pf-note" }, "The question has changed since you answered. Your earlier answer is kept."),
        el("button", { type: "button", onclick: () => {
          this.set(saved.source);
          this.offer.hidden = true;
        } }, "Use it"),
        el("button", { type: "button", onclick: () => {
          keep(this.cell.item + "/old", saved);
          this.offer.hidden = true;
          this.save();
        } }, "Keep the new question"));
    }

    get() { return this.editor.get(); }

    set(text) { this.editor.set(text); }

    async run(check) {
      if (busy) {
        this.note.textContent = "Another answer is still running.";
        return;
      }
      busy = this;
      this.save();
      const index = check ? this.check.index : this.cell.index;
      const cells = JSON.stringify(lab.cells.map((c) => {
        const e = editors.find((x) => x.cell.index === c.index);
        return { index: c.index, kind: c.kind, item: c.item ?? `cell ${c.index}`,
          source: e ? e.get() : c.source };
      }));
      this.runButton.disabled = this.checkButton.disabled = true;
      this.stopButton.hidden = false;
      const began = performance.now();
      let booted = Boolean(python.worker);
      const progress = (text) => { if (busy === this) this.note.textContent = text; };
      python.onProgress(progress);
      let limit = 0;
      const clock = setInterval(() => {
        if (!limit) return;
        const left = Math.ceil((limit - performance.now()) / 1000);
        if (left <= 0) this.stop(`stopped after ${LIMIT.seconds} s: does a loop never end?`);
        else if (left < LIMIT.seconds - 1) this.note.textContent = `Running. It is stopped in ${left} s.`;
      }, 250);
      try {
        await python.start();
        if (!booted || !python.told) await restorePredictions();
        this.note.textContent = "Running.";
        limit = performance.now() + 1000 * LIMIT.seconds;
        const report = JSON.parse(await python.ask({ do: "cell", cells, index }));
        const seconds = ((performance.now() - began) / 1000).toFixed(1);
        this.show(report, check);
        this.note.textContent = (report.error ? "An error." : check ? "Checked." : "Ran.")
          + ` ${seconds} s.` + (report.before.length ? ` Ran ${report.before.length} cell${report.before.length > 1 ? "s" : ""} above first.` : "");
        await keepPredictions();
      } catch (error) {
        this.stopped = this.stopped || String(error.message || error);
        this.show({ text: "", error: this.stopped, status: "" }, check);
        this.note.textContent = this.stopped.slice(0, 160);
        this.stopped = "";
      } finally {
        clearInterval(clock);
        python.listeners.delete(progress);
        this.runButton.disabled = this.checkButton.disabled = false;
        this.stopButton.hidden = true;
        busy = null;
      }
    }

    stop(reason) {
      this.stopped = reason;
      python.told = false;
      python.stop();
    }

    show(report, check) {
      this.out.hidden = !(report.text || report.error);
      this.out.replaceChildren(report.text);
      if (report.error) {
        this.out.append(el("span", { class: "pf-error" }, (report.text && !report.text.endsWith("\n") ? "\n" : "") + report.error));
      }
      if (check) this.root.dataset.status = report.status;
      if (!report.text && !report.error && !check) this.out.hidden = true;
    }
  }

  /* Predictions are locked by the lab itself; the page keeps what it says and gives it back. */
  async function restorePredictions() {
    python.told = true;
    if (!Object.keys(predictions).length) return;
    const text = JSON.stringify({ schema: 1, lab: lab.lab, answers: {}, predictions });
    await python.ask({ do: "restore", lab: lab.lab, text });
  }

  async function keepPredictions() {
    const text = await python.ask({ do: "progress", lab: lab.lab });
    if (!text) return;
    // A lock stays: a Python that was stopped and started anew may not know it yet.
    predictions = { ...predictions, ...JSON.parse(text).predictions };
    storePredictions();
    showLocks();
  }

  function keptPredictions() {
    try {
      return JSON.parse(localStorage.getItem(keyOf("*predictions"))).predictions;
    } catch {
      return null; // nothing kept, or storage refused: the lab starts without predictions
    }
  }

  /* ---- the page --------------------------------------------------------------------------- */
  async function start() {
    const data = document.getElementById("pf-lab");
    if (!data) return;
    lab = JSON.parse(data.textContent);
    python = new PF.Python("cells");
    await PF.loadScript("editor.js");
    const at = (cell) => document.querySelector(`.pf-cell-${cell.index}`);
    const answers = lab.cells.filter((c) => c.kind === "answer" && at(c));
    if (!answers.length) return;
    const note = el("span", { class: "pf-note", role: "status", "aria-live": "polite" });
    const file = el("input", { type: "file", accept: ".json,application/json", id: "pf-import",
      onchange: async () => {
        if (file.files[0]) importAnswers(await file.files[0].text());
        file.value = "";
      } });
    bar = el("div", { class: "pf-labbar", role: "group", "aria-label": "Your answers" },
      el("p", {}, "You can answer in this page. Python runs in your browser, nothing leaves it; "
        + "your answers are kept in this browser."),
      el("button", { type: "button", onclick: exportAnswers }, "Export answers"),
      el("label", { for: "pf-import" }, "Import answers", file), note);
    bar.note = note;
    for (const cell of answers) {
      const check = lab.cells.find((c) => c.kind === "check" && c.item === cell.item);
      const node = at(cell);
      editors.push(new Answer(cell, check, node, check && at(check)));
    }
    editors[0].root.before(bar);
    adopt(keptPredictions());
    new MutationObserver(() => {
      for (const e of editors) e.editor.theme(PF.isDark(e.root));
    }).observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
    addEventListener("pagehide", () => editors.forEach((e) => e.save()));
    PF.lab = { editors, exportAnswers, importAnswers, python, limit: LIMIT };
  }
  start();
})((globalThis.PF = globalThis.PF || {}));
