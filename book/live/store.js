/* What a reader did, kept in this browser and seen by all tabs; each key begins with ROOT.
   Answers: one record each, in a store for each lab. Ticks of missions: a list of deeds for each
   panel, under "missions/". Where the reader was: under "here".

   A record is { source, version, judged, hints }, judged the verdict on some source, hints how many
   checks gave one. All that belongs to the lab lies under a name with a star. Beside it, under
   "item/aside", lies the text of a tab that found another text in its place, and under "item/old"
   the answer to an earlier version of the question. */
(function (PF) {
  "use strict";

  const ROOT = "where-am-i/1/";
  const GOOD = ["passed", "recorded", "predicted"]; // verdicts after which a question is done
  const LONGEST = 200000; // characters of one entry of an imported file

  PF.Store = class {
    constructor(lab) {
      this.lab = lab;
      this.place = `${ROOT}${lab}/`;
    }

    /* Take over what was kept when the lab had another name, unless it was kept again since. */
    bring(former) {
      const then = new PF.Store(former).place;
      try {
        for (const key of Object.keys(localStorage).filter((k) => k.startsWith(then))) {
          const place = this.place + key.slice(then.length);
          if (localStorage.getItem(place) === null) {
            localStorage.setItem(place, localStorage.getItem(key));
          }
        }
      } catch { /* refused or full: nothing can be taken over, and nothing is lost */ }
    }

    /* False if the browser refuses, or is full. */
    write(name, value) {
      try {
        localStorage.setItem(this.place + name, JSON.stringify(value));
        return true;
      } catch {
        return false;
      }
    }

    /* A record, or null for anything else that may lie there. */
    read(name) {
      try {
        return PF.Store.record(localStorage.getItem(this.place + name));
      } catch {
        return null;
      }
    }

    remove(name) {
      try {
        localStorage.removeItem(this.place + name);
      } catch { /* what may not be read may stay */ }
    }

    static record(text) {
      try {
        const value = JSON.parse(text);
        return value && typeof value.source === "string" ? value : null;
      } catch {
        return null;
      }
    }

    /* Predictions are kept in the form of the notebook's own file. */
    predictions() {
      try {
        return JSON.parse(localStorage.getItem(this.place + "*predictions")).predictions || {};
      } catch {
        return {};
      }
    }

    /* A lock stays: what another tab has locked meanwhile is not overwritten. */
    writePredictions(predictions) {
      const all = { ...predictions, ...this.predictions() };
      return this.write("*predictions",
        { schema: 1, lab: this.lab, answers: {}, predictions: all });
    }

    /* What lies under a name with a star: an object, empty if there is none. */
    whole(name) {
      try {
        const found = JSON.parse(localStorage.getItem(this.place + name));
        return found && typeof found === "object" ? found : {};
      } catch {
        return {};
      }
    }

    /* Numbers of the lines of its rubric that the reader ticked, by item. */
    ticks() { return this.whole("*ticks"); }

    writeTicks(item, lines) { return this.write("*ticks", { ...this.ticks(), [item]: lines }); }

    /* Whose questions are asked: { who, term, asked }, asked by item; empty for those in print. */
    student() { return this.whole("*student"); }

    writeStudent(student) { return this.write("*student", student || {}); }

    /* When what was solved comes back: { off, items: { item: { day, times } } }. */
    review() { return this.whole("*review"); }

    writeReview(review) { return this.write("*review", review); }

    /* Tell of what other tabs write: hear(name, text), with text null for a removal. */
    listen(hear) {
      addEventListener("storage", ({ key, newValue }) => {
        if (key && key.startsWith(this.place)) hear(key.slice(this.place.length), newValue);
      });
    }

    /* Whether the present answer to this version of a question has passed, or is locked. */
    done(item, version) {
      const record = this.read(item), judged = record && record.judged;
      const passed = judged && record.version === version && judged.source === record.source
        && GOOD.includes(judged.status);
      return Boolean(passed) || Object.hasOwn(this.predictions(), item);
    }

    /* The value under a key of the course that holds no answer, or null. */
    static get(name) {
      try {
        return JSON.parse(localStorage.getItem(ROOT + name));
      } catch {
        return null;
      }
    }

    static set(name, value) {
      try {
        localStorage.setItem(ROOT + name, JSON.stringify(value));
        return true;
      } catch {
        return false;
      }
    }

    static missions(panel) {
      const deeds = PF.Store.get(`missions/${panel}`);
      return Array.isArray(deeds) ? deeds : [];
    }

    /* All that this browser keeps of the course, as it is kept: { name: text }. */
    static everything() {
      try {
        const keys = Object.keys(localStorage).filter((key) => key.startsWith(ROOT)).sort();
        return Object.fromEntries(keys.map((key) => [key.slice(ROOT.length), localStorage.getItem(key)]));
      } catch {
        return {};
      }
    }

    /* Take in what `everything` gave elsewhere. Nothing here is overwritten: ticks and locks are
       joined, and another answer to a question lies beside the one that stands here, as after a
       conflict of two tabs. Returns how many entries were new, or laid beside. */
    static takeIn(kept) {
      const count = { added: 0, beside: 0 };
      for (const [name, text] of Object.entries(kept)) {
        if (typeof text !== "string" || text.length > LONGEST) continue;
        let theirs;
        try { theirs = JSON.parse(text); } catch { continue; }
        const mine = PF.Store.get(name);
        if (mine === null) count.added += PF.Store.set(name, theirs);
        else if (name.startsWith("missions/") && Array.isArray(theirs)) {
          PF.Store.set(name, [...new Set([...PF.Store.missions(name.slice(9)), ...theirs])]);
        } else if (name.endsWith("*predictions") && theirs && typeof theirs.predictions === "object") {
          const predictions = { ...theirs.predictions, ...mine.predictions };
          PF.Store.set(name, { ...mine, predictions });
        } else if (name.endsWith("*ticks") && theirs && typeof theirs === "object") {
          PF.Store.set(name, { ...theirs, ...mine });
        } else if (PF.Store.record(text) && theirs.source !== mine.source && !name.endsWith("/old")) {
          if (PF.Store.get(`${name}/aside`) === null) count.beside += PF.Store.set(`${name}/aside`, theirs);
        }
      }
      return count;
    }
  };
})((globalThis.PF = globalThis.PF || {}));
