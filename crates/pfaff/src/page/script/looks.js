// The looks of what is painted are those of the style sheet: they are read from elements that nobody sees.

/** Hatches of one line style for each verdict. */
const HATCHES = { hatch: 4, "hatch-wide": 6 };
/** Width of its line as a share of its pitch. */
const HATCH_LINE = 0.45;

/** Steps by which symbols among many are turned (rad). */
const STAMP_TURN = Math.PI / 36;

/** A hatch as a pattern of SVG, with attributes of its ground and of its lines. */
function drawHatch(defs, id, ground, line) {
  const pitch = HATCHES[id];
  const pattern = draw(defs, "pattern", { id, width: pitch, height: pitch, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" });
  draw(pattern, "rect", { width: pitch, height: pitch, ...ground });
  draw(pattern, "rect", { width: pitch * HATCH_LINE, height: pitch, ...line });
}

class Looks {
  constructor(context) {
    this.context = context;
    this.hidden = draw(document.body, "svg", { class: "unseen", "aria-hidden": "true", width: 0, height: 0 });
    const defs = draw(this.hidden, "defs");
    for (const id of Object.keys(HATCHES)) drawHatch(defs, id, { class: "hatch-ground" }, { class: "hatch-line" });
    this.refresh();
  }

  /** Forgets all colours, which may have changed. */
  refresh() {
    this.known = new Map();
    this.symbols = new Map();
    this.stamps = new Map();
    this.page = this.named("--page");
    this.ink = this.named("--ink");
  }

  /** A colour of the style sheet. */
  named(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  }

  /** The look of an element with these classes in groups with those before. */
  of(...classes) {
    const key = classes.join("|");
    if (!this.known.has(key)) this.known.set(key, this.read(classes));
    return this.known.get(key);
  }

  read(classes) {
    const groups = classes.slice(0, -1);
    const root = draw(this.hidden, "g");
    const inner = groups.reduce((parent, name) => draw(parent, "g", { class: name }), root);
    const own = draw(inner, classes.at(-1).startsWith("text ") ? "text" : "path", { class: classes.at(-1).replace("text ", "") });
    const style = getComputedStyle(own);
    const colour = (paint) => {
      if (paint === "none") return null;
      const [, id] = /url\("?#(.*?)"?\)/.exec(paint) ?? [];
      return id ? this.hatch(id) : paint;
    };
    const look = {
      fill: colour(style.fill),
      stroke: colour(style.stroke),
      width: parseFloat(style.strokeWidth),
      dash: style.strokeDasharray === "none" ? [] : style.strokeDasharray.split(/[ ,]+/).map(parseFloat),
      join: style.strokeLinejoin,
      alpha: Number(style.fillOpacity),
      opacity: Number(style.opacity),
      strokeFirst: style.paintOrder.startsWith("stroke"),
      font: `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`,
      size: parseFloat(style.fontSize),
    };
    root.remove();
    return look;
  }

  hatch(id) {
    const pitch = HATCHES[id];
    const ratio = 4;
    const tile = Object.assign(document.createElement("canvas"), { width: pitch * ratio, height: pitch * ratio });
    const at = tile.getContext("2d");
    const [ground, line] = ["hatch-ground", "hatch-line"].map((name) => this.of(name).fill);
    at.fillStyle = ground;
    at.fillRect(0, 0, tile.width, tile.height);
    at.fillStyle = line;
    at.fillRect(0, 0, HATCH_LINE * tile.width, tile.height);
    const pattern = this.context.createPattern(tile, "repeat");
    pattern.setTransform(new DOMMatrix().rotateSelf(45).scaleSelf(1 / ratio));
    // A pattern cannot be read: what it is made of is kept with it, for SVG.
    return Object.assign(pattern, { hatch: { id, ground, line } });
  }

  /** Strokes of a symbol of the drawing model: paths with their looks. */
  symbol(name, classes) {
    const key = `${classes}|${name}`;
    if (!this.symbols.has(key)) {
      const [, , strokes] = data.drawing.shapes[name];
      this.symbols.set(key, strokes.map(([kind, d]) => [new Path(d), classes ? this.of(classes, kind) : this.of(kind)]));
    }
    return this.symbols.get(key);
  }
}

/** Paints on a canvas whose unit is a pixel of the page, whatever the pixels of the screen are. */
class Brush {
  /** The picture itself has no transparency; stamps have. */
  constructor(canvas, looks = null) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: looks !== null });
    this.looks = looks ?? new Looks(this.context);
    this.ratio = 1;
  }

  /** An empty page of a colour, or a transparent new one. */
  clear(width, height, ratio, ground = null) {
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== w || this.canvas.height !== h) Object.assign(this.canvas, { width: w, height: h });
    this.ratio = ratio;
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    if (ground) {
      this.context.fillStyle = ground;
      this.context.fillRect(0, 0, width, height);
    }
  }

  /** Paints at a place: turned by an angle (rad, clockwise on the page) and scaled. */
  at(x, y, angle, size, paint) {
    const { context, ratio } = this;
    const [c, s] = [ratio * size * Math.cos(angle), ratio * size * Math.sin(angle)];
    context.setTransform(c, s, -s, c, ratio * x, ratio * y);
    paint();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  /** Fills and strokes a path; `halo` pixels of the colour of the page keep it apart from what is behind. */
  path(path, look, { halo = 0, width = look.width, cap = "butt", fill = look.fill } = {}) {
    const { context } = this;
    context.lineJoin = look.join;
    context.lineCap = cap;
    if (halo > 0) {
      context.strokeStyle = this.looks.page;
      context.lineWidth = (look.stroke ? width : 0) + 2 * halo;
      context.stroke(path);
    }
    const strokes = () => {
      if (!look.stroke || !(width > 0)) return;
      context.strokeStyle = look.stroke;
      context.lineWidth = width;
      if (look.dash.length) context.setLineDash(look.dash);
      context.stroke(path);
      if (look.dash.length) context.setLineDash([]);
    };
    context.globalAlpha = look.opacity;
    if (look.strokeFirst) strokes();
    if (fill) {
      context.fillStyle = fill;
      context.globalAlpha = look.opacity * look.alpha;
      context.fill(path);
      context.globalAlpha = look.opacity;
    }
    if (!look.strokeFirst) strokes();
    context.globalAlpha = 1;
  }

  /** A symbol of the drawing model; `selected` makes its lines bolder. */
  symbol(name, classes, [x, y], angle = 0, size = 1, { halo = 0, selected = false } = {}) {
    this.at(x, y, angle, size, () => {
      for (const [path, look] of this.looks.symbol(name, classes)) {
        this.path(path, look, { halo, width: selected ? 2 * look.width : look.width });
      }
    });
  }

  /** The same from a picture of it that is kept, at whole pixels: for many symbols, turned by whole steps. */
  stamp(name, classes, [x, y], angle = 0, size = 1, selected = false) {
    const turn = Math.round(angle / STAMP_TURN);
    const key = `${name}|${classes}|${turn}|${size.toFixed(2)}|${selected}|${this.ratio}`;
    let stamp = this.looks.stamps.get(key);
    if (!stamp) {
      const [[w, h], middle] = data.drawing.shapes[name];
      const half = Math.ceil((Math.max(w, h + Math.abs(middle)) + 3) * size * (turn ? Math.SQRT2 : 1));
      const canvas = document.createElement("canvas");
      const own = new Brush(canvas, this.looks);
      own.clear(2 * half, 2 * half, this.ratio);
      own.symbol(name, classes, [half, half], turn * STAMP_TURN, size, { selected });
      stamp = { canvas, half };
      this.looks.stamps.set(key, stamp);
    }
    const { ratio } = this;
    const left = Math.round((x - stamp.half) * ratio) / ratio;
    const top = Math.round((y - stamp.half) * ratio) / ratio;
    this.context.drawImage(stamp.canvas, left, top, 2 * stamp.half, 2 * stamp.half);
  }

  /** A filled polygon whose corners lie along a direction from a place. */
  polygon([x, y], [dx, dy], corners, fill) {
    const { context } = this;
    const length = Math.hypot(dx, dy);
    const [c, s] = [dx / length, dy / length];
    context.beginPath();
    for (const [u, v] of corners) context.lineTo(x + c * u - s * v, y + s * u + c * v);
    context.fillStyle = fill;
    context.fill();
  }

  /** A plain line, for many. */
  stroke(a, b, colour, width) {
    const { context } = this;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(a[0], a[1]);
    context.lineTo(b[0], b[1]);
    context.stroke();
  }

  /** A line between places of the page. */
  line(a, b, look, options) {
    const path = new Path();
    path.moveTo(a[0], a[1]);
    path.lineTo(b[0], b[1]);
    this.path(path, { ...look, fill: null }, options);
  }

  /** A shape that lies along x, from one place of the page towards another. */
  from(a, [dx, dy], d, look, options) {
    this.at(a[0], a[1], Math.atan2(dy, dx), 1, () => this.path(typeof d === "string" ? new Path(d) : d, look, options));
  }

  text(words, x, y, look, align = "left") {
    const { context } = this;
    context.font = look.font;
    context.textAlign = align;
    context.lineJoin = "round";
    if (look.stroke) {
      context.strokeStyle = look.stroke;
      context.lineWidth = look.width;
      context.strokeText(words, x, y);
    }
    context.fillStyle = look.fill;
    context.fillText(words, x, y);
  }

  widthOf(words, look) {
    this.context.font = look.font;
    return this.context.measureText(words).width;
  }
}
