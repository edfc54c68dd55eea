/* How much of each page is done, in the menu and on the map of the course; there, too, the way back
   to where the reader was, and one file with everything. What there is to do comes from tasks.js,
   what is done from store.js. */
(function (PF) {
  "use strict";

  const BIGGEST = 5e6; // characters of a file to import
  const LOOK = 3000; // ms: answers and missions are kept by other scripts, which tell nobody
  const NAME = "where-am-i_progress.json";
  const TOP = new URL(document.documentElement.dataset.content_root || "./", location.href);
  const page = DOCUMENTATION_OPTIONS.pagename;
  const tasks = window.pfTasks || [];
  const courses = tasks.filter((t) => t.items); // pages with questions: chapters and labs

  const make = (tag, properties, ...children) => {
    const e = Object.assign(document.createElement(tag), properties);
    e.append(...children);
    return e;
  };

  function progress({ lab, items, missions }) {
    const store = lab && new PF.Store(lab);
    const answered = (items || []).filter(([item, version]) => store.done(item, version)).length;
    const ticked = missions.map(([panel, most]) => Math.min(most, PF.Store.missions(panel).length));
    const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
    return {
      done: answered + sum(ticked), all: (items || []).length + sum(missions.map(([, most]) => most)),
    };
  }

  /* Beside each link to a page: "7 of 11", as soon as something is done there. */
  function mark() {
    const counts = new Map(tasks.map((t) => [new URL(`${t.page}.html`, TOP).pathname, progress(t)]));
    for (const link of document.querySelectorAll("nav.bd-links a.internal, .bd-article table a")) {
      const count = counts.get(new URL(link.href).pathname);
      if (!count || link.hash.length > 1) continue;
      let told = link.querySelector(".pf-count");
      if (!count.done) { if (told) told.remove(); continue; }
      if (!told) link.append(" ", told = make("span", { className: "pf-count" }));
      const text = `${count.done} of ${count.all}`;
      if (told.textContent !== text) told.textContent = text;
      told.classList.toggle("pf-all", count.done === count.all);
      told.title = "questions and missions done";
    }
    if (bar) total();
  }

  /* ---- where the reader was ---------------------------------------------------------------- */
  function remember() {
    if (!courses.some((t) => t.page === page)) return;
    const heads = [...document.querySelectorAll(".bd-article :is(h1, h2, h3)")];
    const above = heads.filter((h) => h.getBoundingClientRect().top < innerHeight / 2);
    const head = above.at(-1) || heads[0];
    if (!head) return;
    const text = (h) => h.firstChild.textContent.trim();
    const id = head.tagName === "H1" ? "" : head.closest("section").id;
    PF.Store.set("here", { page, id, title: text(heads[0]), section: id ? text(head) : "" });
  }

  function wayBack() {
    const here = PF.Store.get("here");
    const known = here && courses.some((t) => t.page === here.page) && typeof here.id === "string";
    const [first] = courses;
    if (!known) return first ? [first.page, "", `Begin: ${first.title}`] : null;
    return [here.page, here.id,
      `Continue: ${here.title}${here.section ? `, ${here.section}` : ""}`];
  }

  /* ---- the map ------------------------------------------------------------------------------ */
  let bar, summary, note;

  function total() {
    const seen = new Set(); // an explorable that stands on two pages counts once
    const first = ([panel]) => !seen.has(panel) && seen.add(panel);
    const counts = tasks.map((t) => progress({ ...t, missions: t.missions.filter(first) }));
    bar.value = counts.reduce((sum, c) => sum + c.done, 0);
    bar.max = counts.reduce((sum, c) => sum + c.all, 0);
    const text = `${bar.value} of ${bar.max} questions and missions done.`;
    if (summary.textContent !== text) summary.textContent = text;
  }

  function exportAll() {
    const data = { schema: 1, course: "where-am-i", kept: PF.Store.everything() };
    const blob = new Blob([JSON.stringify(data, null, 1) + "\n"], { type: "application/json" });
    const link = make("a", { href: URL.createObjectURL(blob), download: NAME });
    document.body.append(link);
    link.click();
    link.remove();
    note.textContent = `Everything that this browser keeps is in ${NAME}.`;
  }

  function importAll(text) {
    try {
      if (text.length > BIGGEST) throw new Error(`it is larger than ${BIGGEST / 1e6} megabytes`);
      const data = JSON.parse(text);
      if (!data || data.schema !== 1 || data.course !== "where-am-i" || typeof data.kept !== "object") {
        throw new Error("it is no export of this course");
      }
      const { added, beside } = PF.Store.takeIn(data.kept || {});
      mark();
      return `${added} entries are new here.` + (beside ? ` ${beside} answers differ from yours: `
        + "both are kept, and the page of the question lets you choose." : "");
    } catch (error) {
      return `Nothing was imported: ${String(error.message).slice(0, 120)}.`;
    }
  }

  function panel() {
    const title = document.querySelector(".bd-article h1");
    if (page !== "book/map" || !title) return;
    const back = wayBack();
    summary = make("p", {});
    bar = make("progress", { max: 1, value: 0, ariaLabel: "Done in the whole course" });
    note = make("span", { role: "status" });
    const file = make("input", { type: "file", accept: ".json,application/json", onchange: async () => {
      if (file.files[0]) note.textContent = importAll(await file.files[0].text());
      file.value = "";
    } });
    const link = back && make("a", { className: "pf-back", href: new URL(`${back[0]}.html`, TOP)
      + (back[1] ? `#${back[1]}` : "") }, back[2]);
    const box = make("section", { className: "pf-progress", ariaLabel: "Your progress" },
      ...(link ? [make("p", {}, link)] : []), summary, bar,
      make("p", { className: "pf-buttons" },
        make("button", { type: "button", onclick: exportAll }, "Export everything"),
        make("label", {}, "Import", file), note));
    title.after(box);
  }

  panel();
  mark();
  setInterval(() => { if (!document.hidden) mark(); }, LOOK);
  addEventListener("storage", mark);
  addEventListener("pagehide", remember);
  document.addEventListener("visibilitychange", () => { if (document.hidden) remember(); });
})((globalThis.PF = globalThis.PF || {}));
