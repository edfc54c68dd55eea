/* Progress beside the control that was pressed: what is happening, how far it is, and, when it failed,
   "Try again". Words on the screen change as often as they like; those for a screen reader come in
   at most three messages; what comes after `done` is said by whoever pressed. A classic script; adds PF.Loading. */
(function (PF) {
  "use strict";

  PF.Loading = class {
    /* control: what was pressed; say: writes to a live region; at: [x, y] of the page, for a picture */
    constructor(control, say, at) {
      this.control = control;
      this.say = say;
      this.halves = 0;
      this.words = document.createElement("span");
      this.words.className = "pf-loading-words";
      this.words.setAttribute("aria-hidden", "true");
      this.track = document.createElement("span");
      this.track.className = "pf-loading-track";
      this.track.append(document.createElement("span"));
      this.box = document.createElement("span");
      this.box.className = "pf-loading";
      this.box.append(this.words, this.track);
      control.setAttribute("aria-busy", "true");
      control.classList.add("pf-busy");
      this.home = control.closest(".pf-control, .pf-transport, .pf-tools, .pf-stage, .pf-row")
        || control.parentElement;
      this.home.classList.add("pf-loading-home");
      this.home.append(this.box);
      this.at = at;
      this.progress("Starting", 0);
      this.say("Python is loading.");
    }

    /* Below the control, or where the picture was touched; never outside the page's column. */
    place() {
      const home = this.home.getBoundingClientRect(), c = this.control.getBoundingClientRect();
      const frame = (this.control.closest(".pf-explorable, .pf-answer") || this.home)
        .getBoundingClientRect();
      const [x, y] = this.at || [c.left, c.bottom + 4];
      const width = this.box.offsetWidth;
      const left = Math.max(frame.left + 4, Math.min(x, frame.right - width - 4));
      const lowest = this.at ? home.bottom - this.box.offsetHeight - 4 : Infinity;
      this.box.style.left = `${left - home.left}px`;
      this.box.style.top = `${Math.min(y, lowest) - home.top}px`;
    }

    progress(text, fraction) {
      this.words.textContent = text;
      this.track.firstChild.style.width = `${Math.round(100 * fraction)}%`;
      if (fraction >= 0.35 && this.halves < 1) { this.halves = 1; this.say("Half of Python is here."); }
      if (fraction >= 0.7 && this.halves < 2) { this.halves = 2; this.say("Python is starting."); }
      this.place();
    }

    done() {
      this.control.removeAttribute("aria-busy");
      this.control.classList.remove("pf-busy");
      this.box.remove();
    }

    /* Say why, and offer the same once more; the button is the next stop of the Tab key. */
    fail(reason, again) {
      this.done();
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = "Try again";
      button.addEventListener("click", () => {
        this.control.focus?.({ preventScroll: true });
        this.box.remove();
        again();
      });
      this.words.removeAttribute("aria-hidden");
      this.words.textContent = reason;
      this.box.classList.add("pf-failed");
      this.box.replaceChildren(this.words, button);
      this.home.append(this.box);
      this.place();
      this.say(reason);
    }
  };
})((globalThis.PF = globalThis.PF || {}));
