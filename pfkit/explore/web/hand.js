/* The reader's hand on the picture. It takes hold of a handle, or touches the floor. A mouse acts where
   it presses. A finger acts in two ways only: it taps, or it takes hold of a handle and drags it. Any
   other movement scrolls the page, and the picture takes no notice. Whether a touch holds something is
   decided when it begins, by distance. The keyboard takes the handles one after the other.
   A classic script; adds PF.Hand and PF.Thumb. */
(function (PF) {
  "use strict";

  const REACH = { mouse: 14, other: 26 }; // px: for a finger a handle is as large as its tip
  const STILL = 10; // px that a finger may tremble in a tap
  const STRIDE = 8; // px that an arrow key moves a handle
  const ARROWS = { ArrowUp: [0, -1], ArrowDown: [0, 1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

  PF.TOUCHES = ["press", "drag", "release", "tap", "cancel"];

  PF.Hand = class {
    /* act(name, x, y, touch, [clientX, clientY]) in data units, name "" for the floor; floor: does a
       press there do anything? say(sentence) */
    constructor(canvas, renderer, { act, floor, say }) {
      Object.assign(this, { canvas, renderer, act, floor, say });
      this.held = null; // the pointer that acts, and what it holds
      this.taken = null; // what the keyboard holds
      canvas.classList.add("pf-touchable");
      canvas.addEventListener("touchstart", (e) => {
        /* Only this keeps the page from scrolling: it must come before the browser decides. */
        const one = e.touches.length === 1 && e.touches[0];
        if (one && this.near(one.clientX, one.clientY, REACH.other)) e.preventDefault();
      }, { passive: false });
      canvas.addEventListener("pointerdown", (e) => this.down(e));
      canvas.addEventListener("pointermove", (e) => this.move(e));
      canvas.addEventListener("pointerup", (e) => this.up(e));
      canvas.addEventListener("pointercancel", (e) => this.cancel(e));
    }

    /* The handle at a place, or null. */
    near(clientX, clientY, reach) {
      let best = null, least = reach;
      for (const h of this.renderer.handles) {
        const [px, py] = this.renderer.place(h.x, h.y, h.view);
        const gap = Math.hypot(px - clientX, py - clientY);
        if (gap < least) { least = gap; best = h; }
      }
      return best;
    }

    send(touch, clientX, clientY) {
      const { name, view } = this.held;
      const [x, y] = this.renderer.locate(clientX, clientY, view);
      this.act(name, +x.toFixed(4), +y.toFixed(4), touch, [clientX, clientY]);
    }

    down(e) {
      if (!this.renderer.views.length || e.button > 0) return;
      if (this.held) { this.cancel({ pointerId: this.held.id }); return; } // a second finger
      this.letGo("cancel");
      const mouse = e.pointerType === "mouse", from = [e.clientX, e.clientY];
      const handle = this.near(...from, mouse ? REACH.mouse : REACH.other);
      const view = handle ? handle.view : this.floor && this.renderer.floor(...from);
      if (!view) return;
      this.held = { id: e.pointerId, from, name: handle ? handle.name : "", view, acts: mouse || handle };
      if (!this.held.acts) return;
      this.canvas.setPointerCapture(e.pointerId);
      this.canvas.classList.add("pf-holding");
      const [x, y] = handle ? this.renderer.place(handle.x, handle.y, view) : from;
      this.send("press", x, y);
    }

    move(e) {
      if (!this.held) {
        const near = e.pointerType === "mouse" && this.near(e.clientX, e.clientY, REACH.mouse);
        this.canvas.classList.toggle("pf-near", Boolean(near));
        this.canvas.title = near ? `Drag: ${near.name}` : "";
        return;
      }
      if (this.held.id !== e.pointerId) return;
      const moved = Math.hypot(e.clientX - this.held.from[0], e.clientY - this.held.from[1]);
      if (this.held.acts) this.send("drag", e.clientX, e.clientY);
      else if (moved > STILL) this.held = null;
    }

    up(e) {
      if (!this.held || this.held.id !== e.pointerId) return;
      this.send(this.held.acts ? "release" : "tap", e.clientX, e.clientY);
      this.empty();
    }

    /* The browser took the gesture, or a second finger came: put down what was held, start nothing. */
    cancel(e) {
      if (!this.held || this.held.id !== e.pointerId) return;
      if (this.held.acts) this.send("cancel", ...this.held.from);
      this.empty();
    }

    empty() {
      this.held = null;
      this.canvas.classList.remove("pf-holding");
    }

    /* ---- the keyboard's hand: h takes the next handle, arrows move it, Enter puts it down ---- */
    key(e) {
      if (e.key === "h") return this.take();
      if (!this.taken) return false;
      if (e.key === "Enter" || e.key === "Escape") {
        this.letGo(e.key === "Enter" ? "release" : "cancel");
        return true;
      }
      const way = ARROWS[e.key];
      if (!way) return false;
      const { name, view } = this.taken;
      this.taken.at = this.taken.at.map((v, k) => v + STRIDE * way[k]);
      this.sendTaken("drag");
      this.moved = true;
      return Boolean(name && view);
    }

    take() {
      const names = [...new Set(this.renderer.handles.map((h) => h.name))]; // two worlds share them
      if (!names.length) return false;
      const next = names[(names.indexOf(this.taken?.name ?? "") + 1) % names.length];
      this.letGo(this.moved ? "release" : "cancel");
      const h = this.renderer.handles.find(({ name }) => name === next);
      const [x, y] = this.renderer.place(h.x, h.y, h.view), box = this.canvas.getBoundingClientRect();
      this.taken = { name: h.name, view: h.view, at: [x - box.left, y - box.top] };
      this.renderer.held = h.name;
      this.moved = false;
      this.sendTaken("press");
      this.say(`You hold: ${h.name}. Arrow keys move it, Enter puts it down, Escape leaves it.`);
      return true;
    }

    sendTaken(touch) {
      const { name, view, at } = this.taken, box = this.canvas.getBoundingClientRect();
      const [x, y] = this.renderer.locate(at[0] + box.left, at[1] + box.top, view);
      this.act(name, +x.toFixed(4), +y.toFixed(4), touch, null);
    }

    letGo(touch) {
      if (!this.taken) return;
      this.sendTaken(touch);
      this.taken = null;
      this.renderer.held = "";
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
