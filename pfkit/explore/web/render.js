/* Draws any scene: the counterpart of pfkit/explore/pen.py, which documents the array.
   Also decodes recorded runs (pfkit/explore/record.py). A classic script: it adds PF.* and needs
   only PF.palette (pfkit/palette.py), so that it serves the book, a folder on disk, and Jupyter. */
(function (PF) {
  "use strict";

  const { operations: OPERATIONS, shapes: SHAPES, fewest: FEWEST } = PF.drawing; // operations.py
  const FONT = "ui-sans-serif, system-ui, -apple-system, 'Segoe UI', Roboto, Arial, sans-serif";

  function rgb(hex) {
    const n = parseInt(hex.slice(1), 16);
    return [n >> 16, (n >> 8) & 255, n & 255];
  }

  /* Is this element shown on a dark page? Asks the colour that is really behind it. */
  PF.isDark = function (element) {
    for (let e = element; e; e = e.parentElement) {
      const m = getComputedStyle(e).backgroundColor.match(/[\d.]+/g);
      if (m && (m.length < 4 || +m[3] > 0.5)) {
        return 0.2126 * m[0] + 0.7152 * m[1] + 0.0722 * m[2] < 128;
      }
    }
    return matchMedia("(prefers-color-scheme: dark)").matches;
  };

  PF.Renderer = class {
    constructor(canvas, size) {
      this.canvas = canvas;
      this.size = size;
      this.context = canvas.getContext("2d");
      this.dark = false;
      this.last = null;
      this.views = []; // the first view of each part: its floor
      this.handles = []; // { name, x, y, view } of what can be dragged
      this.held = ""; // the handle that the keyboard holds
      this.scratch = document.createElement("canvas");
    }

    /* Match the backing store to the size on the page; call again when that changes. `most`: no
       higher than this; `parts`: how many pictures share the canvas. */
    resize(width, most = Infinity, parts = 1) {
      this.stacked = parts > 1 && width < 520;
      const across = this.stacked ? width : width / parts;
      const narrow = across < 520;
      const down = this.stacked ? parts : 1;
      const whole = down * across * (this.size[1] / this.size[0]) * (narrow ? 1.3 : 1);
      const height = Math.round(Math.min(whole, most));
      const ratio = Math.min(window.devicePixelRatio || 1, 2);
      this.width = width;
      this.height = height;
      this.ratio = ratio;
      this.fontScale = narrow ? 0.92 : 1;
      this.canvas.style.height = height + "px";
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      if (this.last) this.draw(this.last);
    }

    get colours() { return this.dark ? PF.palette.dark : PF.palette.light; }

    color(style) { return this.colours[PF.palette.styles[style]]; }

    draw(data) {
      this.last = data;
      this.views = [];
      this.handles = [];
      this.box = { x: 0, y: 0, w: this.width, h: this.height };
      this.fresh = true; // the next view is the first of its part
      const c = this.context;
      c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
      c.save();
      c.fillStyle = this.colours.paper;
      c.fillRect(0, 0, this.width, this.height);
      c.lineCap = "round";
      c.lineJoin = "round";
      for (let i = 0; i + 3 <= data.length;) {
        const op = data[i], style = data[i + 1], n = data[i + 2];
        const d = data.subarray(i + 3, i + 3 + n);
        if (op === 1) this.view(d);
        c.strokeStyle = c.fillStyle = this.color(style);
        c.globalAlpha = 1;
        if (op !== 1) this[OPERATIONS[op].name](d, style);
        i += 3 + n;
      }
      c.restore();
      c.globalAlpha = 1;
      for (const h of this.handles) this.grip(h);
    }

    part([k, n]) {
      const w = this.stacked ? this.width : this.width / n, h = this.stacked ? this.height / n : this.height;
      this.box = { x: this.stacked ? 0 : k * w, y: this.stacked ? k * h : 0, w, h };
      this.fresh = true;
      const c = this.context;
      c.restore();
      c.save();
      c.strokeStyle = this.colours.grid;
      c.lineWidth = 1;
      if (k) c.strokeRect(this.box.x, this.box.y - 1, this.box.w + 1, this.box.h + 2);
    }

    /* What can be dragged shows a ring; what has the keyboard, or a hand near it, a bigger one. */
    handle(d) {
      const name = String.fromCodePoint(...d.subarray(3));
      this.handles.push({ name, x: d[0], y: d[1], view: this.v, shown: Boolean(d[2]) });
    }

    grip({ name, x, y, view, shown }) {
      const held = name === this.held;
      if (!shown && !held) return;
      const c = this.context;
      c.beginPath();
      c.arc(view.left + (x - view.x0) * view.sx, view.bottom - (y - view.y0) * view.sy,
        held ? 11 : 5, 0, 7);
      c.fillStyle = this.colours.paper;
      if (!held) c.fill();
      c.strokeStyle = this.colours.ink;
      c.lineWidth = held ? 3 : 2;
      c.stroke();
    }

    view(d) {
      const [l, b, w, h, x0, x1, y0, y1, equal, framed] = d;
      const box = this.box;
      let left = box.x + l * box.w, width = w * box.w;
      let bottom = box.y + (1 - b) * box.h, height = h * box.h;
      let sx = width / (x1 - x0), sy = height / (y1 - y0);
      if (equal) {
        const s = Math.min(sx, sy);
        left += (width - s * (x1 - x0)) / 2;
        bottom -= (height - s * (y1 - y0)) / 2;
        sx = sy = s;
        width = s * (x1 - x0);
        height = s * (y1 - y0);
      }
      this.v = { left, bottom, width, height, sx, sy, x0, x1, y0, y1 };
      if (this.fresh) this.views.push(this.v);
      this.fresh = false;
      /* A map is cut at its edge; charts may write beside themselves. */
      const c = this.context;
      c.restore();
      c.save();
      if (equal) {
        c.beginPath();
        c.rect(left - 1, bottom - height - 1, width + 2, height + 2);
        c.clip();
      }
      if (framed) {
        c.strokeStyle = this.colours.grid;
        c.lineWidth = 1;
        c.strokeRect(Math.round(left) + 0.5, Math.round(bottom - height) + 0.5,
          Math.round(width), Math.round(height));
      }
    }

    X(x) { return this.v.left + (x - this.v.x0) * this.v.sx; }
    Y(y) { return this.v.bottom - (y - this.v.y0) * this.v.sy; }

    /* Data coordinates of a place on the page, in a view. */
    locate(clientX, clientY, v) {
      const box = this.canvas.getBoundingClientRect();
      return [v.x0 + (clientX - box.left - v.left) / v.sx,
        v.y0 - (clientY - box.top - v.bottom) / v.sy];
    }

    /* The other way round: where a place in a view is on the page. */
    place(x, y, v) {
      const box = this.canvas.getBoundingClientRect();
      return [box.left + v.left + (x - v.x0) * v.sx, box.top + v.bottom - (y - v.y0) * v.sy];
    }

    /* The view whose floor is at a place on the page, or null. */
    floor(clientX, clientY) {
      return this.views.find((v) => {
        const [x, y] = this.locate(clientX, clientY, v);
        return x >= v.x0 && x <= v.x1 && y >= v.y0 && y <= v.y1;
      }) || null;
    }

    points(d, style) {
      const n = (d.length - 1) / 2, size = d[0], c = this.context;
      if (n > 1500) return this.splat(d, style, n);
      c.globalAlpha = Math.max(0.25, Math.min(0.85, 90 / Math.sqrt(n * 60 + 1)));
      c.beginPath();
      for (let k = 1; k <= n; k++) {
        const x = this.X(d[k]), y = this.Y(d[k + n]);
        c.moveTo(x + size / 2, y);
        c.arc(x, y, size / 2, 0, 7);
      }
      c.fill();
    }

    /* Large clouds go to pixels directly: one pass, no path, and density becomes tone. */
    splat(d, style, n) {
      const v = this.v, r = this.ratio, c = this.context;
      const W = Math.max(1, Math.round(v.width * r)), H = Math.max(1, Math.round(v.height * r));
      const s = this.scratch;
      if (s.width !== W || s.height !== H) { s.width = W; s.height = H; this.density = null; }
      const sc = s.getContext("2d");
      if (!this.density || this.density.length !== W * H) {
        this.density = new Float32Array(W * H);
        this.pixels = sc.createImageData(W, H);
      }
      const density = this.density, out = this.pixels.data;
      density.fill(0);
      const gain = Math.max(0.1, Math.min(0.6, 60 / Math.sqrt(n) - 0.1));
      const side = Math.max(1, Math.round(r * 1.6));
      for (let k = 1; k <= n; k++) {
        const px = Math.round((d[k] - v.x0) * v.sx * r - side / 2);
        const py = Math.round((v.y1 - d[k + n]) * v.sy * r - side / 2);
        if (px < 0 || py < 0 || px + side > W || py + side > H) continue;
        for (let j = 0; j < side; j++) {
          const row = (py + j) * W + px;
          for (let i = 0; i < side; i++) density[row + i] += gain;
        }
      }
      const [R, G, B] = rgb(this.color(style));
      for (let p = 0, q = 0; p < density.length; p++, q += 4) {
        const a = density[p];
        out[q + 3] = a ? 255 * (1 - 1 / (1 + a * 1.6)) + 40 : 0;
        out[q] = R; out[q + 1] = G; out[q + 2] = B;
      }
      sc.putImageData(this.pixels, 0, 0);
      c.drawImage(s, v.left, v.bottom - v.height, v.width, v.height);
    }

    bubbles(d) {
      const n = d.length / 3, c = this.context;
      c.globalAlpha = 0.55;
      c.beginPath();
      for (let k = 0; k < n; k++) {
        const r = d[k + 2 * n] / 2, x = this.X(d[k]), y = this.Y(d[k + n]);
        c.moveTo(x + r, y);
        c.arc(x, y, r, 0, 7);
      }
      c.fill();
    }

    segments(d) {
      const n = (d.length - 1) / 4, c = this.context;
      c.lineWidth = d[0];
      c.beginPath();
      for (let k = 1; k <= n; k++) {
        c.moveTo(this.X(d[k]), this.Y(d[k + n]));
        c.lineTo(this.X(d[k + 2 * n]), this.Y(d[k + 3 * n]));
      }
      c.stroke();
    }

    trace(d, lead) {
      const n = (d.length - lead) / 2, c = this.context;
      let down = false;
      c.beginPath();
      for (let k = lead; k < lead + n; k++) {
        if (Number.isNaN(d[k]) || Number.isNaN(d[k + n])) { down = false; continue; }
        if (down) c.lineTo(this.X(d[k]), this.Y(d[k + n]));
        else c.moveTo(this.X(d[k]), this.Y(d[k + n]));
        down = true;
      }
    }

    line(d) {
      const c = this.context;
      c.lineWidth = d[0];
      c.setLineDash(d[1] ? [d[1], d[1]] : []);
      this.trace(d, 2);
      c.stroke();
      c.setLineDash([]);
    }

    area(d) {
      this.context.globalAlpha = d[0];
      this.trace(d, 1);
      this.context.fill();
    }

    bars(d) {
      const n = (d.length - 1) / 4, c = this.context;
      c.globalAlpha = d[0];
      for (let k = 1; k <= n; k++) {
        const x0 = this.X(d[k]), x1 = this.X(d[k + n]);
        const y0 = this.Y(d[k + 2 * n]), y1 = this.Y(d[k + 3 * n]);
        c.fillRect(x0, y1, x1 - x0, y0 - y1);
      }
    }

    /* The shapes of pfkit.plotting: truth a filled arrowhead, a guess an empty ring with a nose, which
       hides nothing. */
    robots(d, style) {
      const n = (d.length - 2) / 3, c = this.context;
      const r = Math.max(d[0] * this.v.sx, 5), colour = this.color(style);
      for (let k = 2; k < 2 + n; k++) {
        c.save();
        c.translate(this.X(d[k]), this.Y(d[k + n]));
        c.rotate(-d[k + 2 * n]);
        c.beginPath();
        if (d[1]) {
          c.arc(0, 0, r, 0, 2 * Math.PI);
          c.moveTo(r, 0);
          c.lineTo(r * 1.7, 0);
        } else {
          c.moveTo(r * 1.5, 0);
          c.lineTo(-r, r * 0.85);
          c.lineTo(-r, -r * 0.85);
          c.closePath();
        }
        c.strokeStyle = d[1] ? colour : this.colours.paper;
        c.lineWidth = d[1] ? 2 : 1;
        if (!d[1]) c.fill();
        c.stroke();
        c.restore();
      }
    }

    ellipses(d) {
      const n = (d.length - 2) / 5, c = this.context;
      c.lineWidth = d[0];
      c.setLineDash(d[1] ? [d[1], d[1]] : []);
      for (let k = 2; k < 2 + n; k++) {
        c.beginPath();
        c.ellipse(this.X(d[k]), this.Y(d[k + n]), Math.abs(d[k + 2 * n] * this.v.sx),
          Math.abs(d[k + 3 * n] * this.v.sy), -d[k + 4 * n], 0, 2 * Math.PI);
        c.stroke();
      }
      c.setLineDash([]);
    }

    stems(d) {
      const n = (d.length - 2) / 2, c = this.context, base = this.Y(d[0]);
      c.lineWidth = 1.3;
      c.globalAlpha = 0.75;
      c.beginPath();
      for (let k = 2; k < 2 + n; k++) {
        const x = this.X(d[k]);
        c.moveTo(x, base);
        c.lineTo(x, this.Y(d[k + n]));
      }
      c.stroke();
      c.globalAlpha = 1;
      c.beginPath();
      for (let k = 2; k < 2 + n; k++) {
        const x = this.X(d[k]), y = this.Y(d[k + n]);
        c.moveTo(x + d[1] / 2, y);
        c.arc(x, y, d[1] / 2, 0, 7);
      }
      c.fill();
    }

    image(d, style) {
      const [nx, ny, x0, x1, y0, y1] = d, cells = d.subarray(6);
      const [R, G, B] = rgb(this.color(style));
      const s = this.tile = this.tile || document.createElement("canvas");
      s.width = nx;
      s.height = ny;
      const sc = s.getContext("2d"), pixels = sc.createImageData(nx, ny);
      for (let j = 0; j < ny; j++) {
        for (let i = 0; i < nx; i++) {
          const q = 4 * ((ny - 1 - j) * nx + i);
          pixels.data[q] = R;
          pixels.data[q + 1] = G;
          pixels.data[q + 2] = B;
          pixels.data[q + 3] = 255 * Math.max(0, Math.min(1, cells[j * nx + i]));
        }
      }
      sc.putImageData(pixels, 0, 0);
      const c = this.context, X0 = this.X(x0), Y1 = this.Y(y1);
      c.imageSmoothingEnabled = nx * ny > 400;
      c.drawImage(s, X0, Y1, this.X(x1) - X0, this.Y(y0) - Y1);
    }

    text(d) {
      const c = this.context;
      c.font = `500 ${Math.max(10, d[2] * this.fontScale)}px ${FONT}`;
      c.textAlign = d[3] < 0 ? "left" : d[3] > 0 ? "right" : "center";
      c.textBaseline = "middle";
      c.fillText(String.fromCodePoint(...d.subarray(4)), this.X(d[0]), this.Y(d[1]));
    }

    symbols(d) {
      const n = (d.length - 2) / 2, c = this.context, r = d[1] / 2, shape = SHAPES[d[0]];
      c.lineWidth = 2;
      for (let k = 2; k < 2 + n; k++) {
        const x = this.X(d[k]), y = this.Y(d[k + n]);
        c.beginPath();
        if (shape === "cross" || shape === "plus") {
          const e = shape === "cross" ? r * 0.75 : 0, f = shape === "cross" ? r * 0.75 : r;
          c.moveTo(x - f, y - e); c.lineTo(x + f, y + e);
          c.moveTo(x + e, y - f); c.lineTo(x - e, y + f);
          c.stroke();
          continue;
        }
        if (shape === "circle") c.arc(x, y, r, 0, 7);
        else {
          const corners = { square: 4, diamond: 4, triangle: 3, star: 10 }[shape];
          const turn = shape === "square" ? Math.PI / 4 : 0;
          for (let j = 0; j < corners; j++) {
            const a = turn + (2 * Math.PI * j) / corners - Math.PI / 2;
            const q = shape === "star" && j % 2 ? r * 0.45 : shape === "square" ? r * 1.3 : r;
            c.lineTo(x + q * Math.cos(a), y + q * Math.sin(a));
          }
          c.closePath();
        }
        c.fill();
        c.strokeStyle = this.colours.paper;
        c.lineWidth = 1;
        c.stroke();
        c.strokeStyle = c.fillStyle;
      }
    }

    quills(d) {
      const n = (d.length - 2) / 3, c = this.context, length = d[0], r = d[1] / 2;
      c.lineWidth = 1;
      c.globalAlpha = Math.max(0.25, Math.min(0.8, 70 / Math.sqrt(n * 60 + 1)));
      const dots = new Path2D();
      c.beginPath();
      for (let k = 2; k < 2 + n; k++) {
        const x = this.X(d[k]), y = this.Y(d[k + n]), a = d[k + 2 * n];
        c.moveTo(x, y);
        c.lineTo(x + length * Math.cos(a), y - length * Math.sin(a));
        dots.rect(x - r, y - r, 2 * r, 2 * r);
      }
      c.stroke();
      c.fill(dots);
    }

    ticks(d) {
      const c = this.context, side = d[0];
      c.font = `${11 * this.fontScale}px ${FONT}`;
      c.lineWidth = 1;
      c.textBaseline = side ? "middle" : "top";
      c.textAlign = side ? "right" : "center";
      c.beginPath();
      for (let k = 1; k < d.length; k++) {
        const label = String(+d[k].toPrecision(6)).replace("-", "\u2212");
        if (side) {
          const y = this.Y(d[k]), x = this.v.left;
          c.moveTo(x - 4, y); c.lineTo(x, y);
          c.fillText(label, x - 6, y);
        } else {
          const x = this.X(d[k]), y = this.v.bottom;
          c.moveTo(x, y); c.lineTo(x, y + 4);
          c.fillText(label, x, y + 6);
        }
      }
      c.stroke();
    }
  };

  /* ---- recorded runs ----------------------------------------------------------------------- */
  async function inflate(text) {
    const bytes = Uint8Array.from(atob(text), (ch) => ch.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  function unplane(bytes, width) {
    const n = bytes.length / width, out = new Uint8Array(bytes.length);
    for (let b = 0; b < width; b++) {
      for (let i = 0; i < n; i++) out[i * width + b] = bytes[b * n + i];
    }
    return out.buffer;
  }

  /* How the numbers of a record were stored: see pfkit/explore/record.py. */
  const BESIDE = 1, BEFORE = 2, DESCENT = 3;

  PF.decode = async function (recording) {
    const heads = new Int32Array(unplane(await inflate(recording.heads), 4));
    const floats = new Float32Array(unplane(await inflate(recording.floats), 4));
    const deltas = new Int16Array(unplane(await inflate(recording.deltas), 2));
    const ranges = new Map(recording.ranges.map(
      ([op, style, nth, row, low, scale]) => [`${op} ${style} ${nth} ${row}`, [low, scale]]));
    const levels = new Map();
    let h = 0, f = 0, d = 0;

    function rows(key, count, length, mode, descent) {
      const old = levels.get(key), now = new Int32Array(count * length), out = [];
      for (let r = 0; r < count; r++) {
        const [low, scale] = ranges.get(`${key} ${r}`);
        for (let k = 0, level = 0; k < length; k++) {
          if (mode === BESIDE) level += deltas[d++];
          else {
            const from = mode === DESCENT && descent[k] >= 0 ? descent[k] : k;
            level = old[r * length + from] + deltas[d++];
          }
          now[r * length + k] = level;
          out.push(low + scale * level);
        }
      }
      levels.set(key, now);
      return out;
    }

    return recording.frames.map(([records, descended, ticks, readouts, name, sentence]) => {
      const out = [], modes = [], seen = new Map(), descent = new Int32Array(descended);
      for (let k = 0, at = 0; k < descended; k++) descent[k] = at += deltas[d++];
      for (let j = 0; j < records; j++, h += 4) {
        const op = heads[h], style = heads[h + 1], n = heads[h + 2], mode = heads[h + 3];
        const { lead, rows: count } = OPERATIONS[op], kind = `${op} ${style}`;
        const nth = seen.get(kind) || 0;
        seen.set(kind, nth + 1);
        out.push(op, style, n);
        for (let k = 0; k < (mode ? lead : n); k++) out.push(floats[f++]);
        if (mode) out.push(...rows(`${kind} ${nth}`, count, (n - lead) / count, mode, descent));
        modes.push(mode);
      }
      const report = { ticks, readouts: [readouts], phase: { count: 0, name, sentences: [sentence] } };
      return { drawing: Float32Array.from(out), modes, descent, report };
    });
  };

  /* The records of a drawing by their keys: [start of the numbers, how many, place in the order]. */
  function index(drawing) {
    const found = new Map(), seen = new Map();
    for (let i = 0, j = 0; i + 3 <= drawing.length; i += 3 + drawing[i + 2], j++) {
      const kind = `${drawing[i]} ${drawing[i + 1]}`, nth = seen.get(kind) || 0;
      seen.set(kind, nth + 1);
      found.set(`${kind} ${nth}`, [i + 3, drawing[i + 2], j]);
    }
    return found;
  }

  /* A drawing between two frames of a recording, a share of the way from a to b. A particle comes from
     its ancestor; members of a set whose descent is not known wait. */
  PF.tween = function (a, b, share) {
    a.index = a.index || index(a.drawing);
    b.index = b.index || index(b.drawing);
    const out = Float32Array.from(a.drawing);
    for (const [key, [start, n]] of a.index) {
      const op = OPERATIONS[a.drawing[start - 3]], there = b.index.get(key);
      if (!op.move || !there || there[1] !== n) continue;
      const mode = b.modes[there[2]];
      if (op.loose && mode === BESIDE) continue;
      const length = (n - op.lead) / (op.rows || 3), descends = mode === DESCENT;
      const turns = op.move === "angle" ? n - length : Infinity;
      for (let k = op.lead; k < n; k++) {
        const member = (k - op.lead) % length, from = descends ? b.descent[member] : member;
        const p = descends && from >= 0 ? a.drawing[start + k - member + from] : a.drawing[start + k];
        let gap = b.drawing[there[0] + k] - p;
        if (k >= turns) gap -= 2 * Math.PI * Math.round(gap / (2 * Math.PI));
        out[start + k] = descends && from < 0 ? b.drawing[there[0] + k] : p + share * gap;
      }
    }
    return out;
  };
})((globalThis.PF = globalThis.PF || {}));
