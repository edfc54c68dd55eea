/* The reader's hand on the picture. A mouse acts where it presses. A finger acts in two ways only: it
   taps, or it takes hold of a handle and drags it. Any other movement scrolls the page, and the
   picture takes no notice. Whether a touch holds something is decided when it begins, by distance.
   A classic script; adds PF.Hand
   and PF.Thumb. */
(function (PF) {
  "use strict";

  const REACH = 26; // px: a handle is as large as a fingertip
  const STILL = 10; // px that a finger may tremble in a tap
  const PRESS = 0, DRAG = 1, RELEASE = 2, TAP = 3, CANCEL = 4;

  PF.Hand = class {
    /* act(x, y, phase, [clientX, clientY]) in data units; handles() -> [[x, y]] in data units */
    constructor(canvas, renderer, handles, act) {
      this.renderer = renderer;
      this.handles = handles;
      this.act = act;
      this.held = null; // the pointer that acts, and what it holds
      canvas.classList.add("pf-touchable");
      canvas.addEventListener("touchstart", (e) => {
        /* Only this keeps the page from scrolling: it must come before the browser decides. */
        const one = e.touches.length === 1 && e.touches[0];
        if (one && this.near(one.clientX, one.clientY)) e.preventDefault();
      }, { passive: false });
      canvas.addEventListener("pointerdown", (e) => this.down(e, canvas));
      canvas.addEventListener("pointermove", (e) => this.move(e));
      canvas.addEventListener("pointerup", (e) => this.up(e));
      canvas.addEventListener("pointercancel", (e) => this.cancel(e));
    }

    /* The handle under a fingertip, in data units, or null. */
    near(clientX, clientY) {
      let best = null, least = REACH;
      for (const [x, y] of this.handles()) {
        const [px, py] = this.renderer.place(x, y);
        const gap = Math.hypot(px - clientX, py - clientY);
        if (gap < least) { least = gap; best = [x, y]; }
      }
      return best;
    }

    send(e, phase, at) {
      const [x, y] = at || this.renderer.locate(e.clientX, e.clientY);
      this.act(+x.toFixed(4), +y.toFixed(4), phase, [e.clientX, e.clientY]);
    }

    down(e, canvas) {
      if (!this.renderer.first || e.button > 0) return;
      if (this.held) { this.cancel({ pointerId: this.held.id }); return; } // a second finger
      const from = [e.clientX, e.clientY];
      const handle = e.pointerType === "mouse" ? null : this.near(...from);
      this.held = { id: e.pointerId, from, acts: e.pointerType === "mouse" || Boolean(handle) };
      if (!this.held.acts) return;
      canvas.setPointerCapture(e.pointerId);
      this.send(e, PRESS, handle);
    }

    move(e) {
      if (!this.held || this.held.id !== e.pointerId) return;
      const moved = Math.hypot(e.clientX - this.held.from[0], e.clientY - this.held.from[1]);
      if (this.held.acts) this.send(e, DRAG);
      else if (moved > STILL) this.held = null;
    }

    up(e) {
      if (!this.held || this.held.id !== e.pointerId) return;
      this.send(e, this.held.acts ? RELEASE : TAP);
      this.held = null;
    }

    /* The browser took the gesture, or a second finger came: put down what was held, start nothing. */
    cancel(e) {
      if (!this.held || this.held.id !== e.pointerId) return;
      const { acts, from } = this.held;
      this.held = null;
      if (acts) this.send({ clientX: from[0], clientY: from[1] }, CANCEL);
    }
  };

  /* A finger on a slider. Browsers move the thumb as soon as a swipe begins there; the value counts only
     when the finger went sideways or was lifted in its place, else the old one comes back. */
  PF.Thumb = class {
    constructor(slider, act, restore) {
      this.undecided = null;
      const settle = (keep) => {
        const { value } = this.undecided;
        this.undecided = null;
        if (!keep) restore(value);
        else if (slider.value !== value) act();
      };
      const went = (e) => [Math.abs(e.clientX - this.undecided.x), Math.abs(e.clientY - this.undecided.y)];
      slider.addEventListener("pointerdown", (e) => {
        if (e.pointerType === "mouse") return;
        this.undecided = { value: slider.value, x: e.clientX, y: e.clientY };
      });
      slider.addEventListener("pointermove", (e) => {
        if (!this.undecided) return;
        const [across, along] = went(e);
        if (across > STILL && across > along) settle(true);
      });
      slider.addEventListener("pointerup", (e) => {
        if (this.undecided) settle(went(e)[1] <= STILL);
      });
      slider.addEventListener("pointercancel", () => { if (this.undecided) settle(false); });
    }
  };
})((globalThis.PF = globalThis.PF || {}));
