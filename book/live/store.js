/* What a reader answered, kept in this browser: one record per answer, seen by all tabs.
   A record is { source, version, judged, hints }, judged the verdict on some source, hints how many
   checks gave one. All that belongs to the lab lies under a name with a star. Beside it, under
   "item/aside", lies the text of a tab that found another text in its place, and under "item/old"
   the answer to an earlier version of the question. */
(function (PF) {
  "use strict";

  PF.Store = class {
    constructor(lab) {
      this.lab = lab;
      this.place = `where-am-i/1/${lab}/`;
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
  };
})((globalThis.PF = globalThis.PF || {}));
