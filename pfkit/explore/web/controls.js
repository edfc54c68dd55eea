/* One control of a scene as something to press, slide or choose. A classic script; adds PF.el,
   PF.written and PF.control. */
(function (PF) {
  "use strict";

  PF.el = function (tag, attributes, ...children) {
    const e = document.createElement(tag);
    for (const [k, v] of Object.entries(attributes || {})) {
      if (k.startsWith("on")) e.addEventListener(k.slice(2), v);
      else if (v === true) e.setAttribute(k, "");
      else if (v !== false && v != null) e.setAttribute(k, v);
    }
    e.append(...children.filter((c) => c != null));
    return e;
  };
  const el = PF.el;

  const LETTERS = 20; // that a row of choices beside the picture has room for

  /* A number with the decimals it always has, whatever its size. */
  PF.written = function (value, decimals) {
    if (typeof value !== "number") return value;
    const text = value.toFixed(decimals);
    if (Number(text) === 0) return text.replace("-", "");
    const [whole, part] = text.split(".");
    const grouped = Math.abs(value) < 10000 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, "\u2009");
    return (part ? `${grouped}.${part}` : grouped).replace("-", "\u2212");
  };

  function toggle(c, a) {
    const box = el("input", { type: "checkbox", id: a.id, role: "switch", checked: a.value,
      "aria-describedby": a.described, onchange: () => a.act(box.checked, box) });
    const node = el("div", { class: "pf-control pf-is-toggle" },
      el("label", { for: a.id }, box, el("span", {}, a.label)), a.help);
    return { node, write: (v) => { box.checked = v; } };
  }

  function select(c, a) {
    const list = el("select", { id: a.id, "aria-describedby": a.described,
      onchange: () => a.act(list.value, list) },
    ...c.choices.map(([k, label]) => el("option", { value: k, selected: k === a.value }, label)));
    const node = el("div", { class: "pf-control" }, el("label", { for: a.id }, a.label), list, a.help);
    return { node, write: (v) => { list.value = v; } };
  }

  function radios(c, a) {
    const group = el("div", { class: "pf-segments" });
    const all = c.choices.map(([k, label]) => {
      const radio = el("input", { type: "radio", name: a.id, value: k, checked: k === a.value,
        onchange: () => a.act(k, radio) });
      group.append(el("label", {}, radio, el("span", {}, label)));
      return radio;
    });
    const node = el("fieldset", { class: "pf-control", "aria-describedby": a.described },
      el("legend", {}, a.label), group, a.help);
    return { node, write: (v) => all.forEach((r) => { r.checked = r.value === v; }) };
  }

  function slider(c, a) {
    const log = c.log && c.lo > 0;
    const to = (v) => log ? (1000 * Math.log(v / c.lo)) / Math.log(c.hi / c.lo) : v;
    const from = (p) => {
      const raw = log ? c.lo * Math.pow(c.hi / c.lo, p / 1000) : +p;
      const grid = log && raw > 20 * c.step ? Math.pow(10, Math.floor(Math.log10(raw)) - 1) : c.step;
      return Math.min(c.hi, Math.max(c.lo, +(Math.round(raw / grid) * grid).toFixed(8)));
    };
    const decimals = Math.max(0, Math.ceil(-Math.log10(c.step) - 1e-9));
    const shown = el("output", { for: a.id });
    const bar = el("input", { type: "range", id: a.id, min: log ? 0 : c.lo, max: log ? 1000 : c.hi,
      step: log ? 1 : c.step, "aria-describedby": a.described, oninput: () => {
        label(from(bar.value));
        if (!thumb.undecided) act();
      } });
    const act = () => a.act(from(bar.value), bar);
    const thumb = new PF.Thumb(bar, act, (old) => { bar.value = old; label(from(old)); });
    const label = (v) => {
      shown.textContent = PF.written(v, decimals) + (c.unit ? "\u202f" + c.unit : "");
      bar.setAttribute("aria-valuetext", shown.textContent);
    };
    const write = (v) => { bar.value = to(v); label(v); };
    write(a.value);
    const node = el("div", { class: "pf-control" }, el("label", { for: a.id }, a.label, shown), bar,
      a.help);
    return { node, write };
  }

  /* c: the description; act(value, element): the reader moved it; note: added to its name. */
  PF.control = function (c, id, value, act, note = "") {
    const help = c.help ? el("span", { class: "pf-help", id: id + "-help" }, c.help) : null;
    const described = c.help ? id + "-help" : null, label = c.label + note;
    if (c.kind === "button") {
      const button = el("button", { type: "button", "aria-describedby": described,
        onclick: (e) => act(true, e.currentTarget) }, label);
      return { node: el("div", { class: "pf-control pf-is-button" }, button, help), write: () => {} };
    }
    const letters = c.choices.reduce((sum, [, name]) => sum + name.length, 0);
    const fits = c.choices.length <= 3 && letters <= LETTERS; // in one row
    const make = { toggle, range: slider, choice: fits ? radios : select }[c.kind];
    return make(c, { id, label, help, described, value, act });
  };

  /* A value that shows what a control does, beside the present one. */
  PF.contrast = function (c, value) {
    if (c.kind === "toggle") return !value;
    if (c.kind === "choice") {
      const keys = c.choices.map(([k]) => k);
      return keys[(keys.indexOf(value) + 1) % keys.length];
    }
    if (c.log) return value * 10 <= c.hi ? value * 10 : Math.max(c.lo, value / 10);
    return value > (c.lo + c.hi) / 2 ? c.lo : c.hi;
  };
})((globalThis.PF = globalThis.PF || {}));
