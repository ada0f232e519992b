// The picture as an SVG document. A recorder stands for a canvas and its context: it has the members that the painters use, and writes an
// element for each stroke, fill and text. Any other member is an error, so that a saved picture is complete.

class Recorder {
  constructor() {
    this.root = draw(null, "svg", { role: "img", "xml:space": "preserve" });
    this.defs = draw(this.root, "defs");
    // Miter limit of a canvas; the default of SVG is 4.
    this.layer = draw(this.root, "g", { "clip-path": "url(#page)", "stroke-miterlimit": 10 });
    this.ruler = document.createElement("canvas").getContext("2d");
    Object.assign(this, { width: 0, height: 0, path: new Path(), transform: null, dash: [] });
    Object.assign(this, {
      fillStyle: "#000", strokeStyle: "#000", globalAlpha: 1, lineWidth: 1, lineJoin: "miter", lineCap: "butt", font: "", textAlign: "left",
    });
    Object.preventExtensions(this);
  }

  getContext() {
    return this;
  }

  setTransform(...matrix) {
    if (!matrix.every(Number.isFinite)) return;
    const isPlain = [1, 0, 0, 1, 0, 0].every((x, k) => x === matrix[k]);
    this.transform = isPlain ? null : `matrix(${matrix.map((x) => tidy(x, 4)).join(" ")})`;
  }

  setLineDash(dash) {
    this.dash = dash;
  }

  beginPath() {
    this.path = new Path();
  }

  moveTo(x, y) {
    this.path.moveTo(x, y);
  }

  lineTo(x, y) {
    this.path.lineTo(x, y);
  }

  arc(x, y, r, from, to) {
    this.path.arc(x, y, r, from, to);
  }

  closePath() {
    this.path.closePath();
  }

  fillRect(x, y, width, height) {
    this.add("rect", { x, y, width, height, ...this.paint("fill", this.fillStyle) });
  }

  fill(path = this.path) {
    this.add("path", { d: dataOf(path), ...this.paint("fill", this.fillStyle) });
  }

  /** A stroke of what was just filled becomes one element with it. */
  stroke(path = this.path) {
    const d = dataOf(path);
    const lines = this.lines();
    const last = this.layer.lastElementChild;
    const isSame = last?.getAttribute("d") === d && last.getAttribute("transform") === this.transform && !last.hasAttribute("stroke");
    if (isSame) setAll(last, lines);
    else this.add("path", { d, fill: "none", ...lines });
  }

  fillText(words, x, y) {
    this.text(words, x, y, this.paint("fill", this.fillStyle));
  }

  strokeText(words, x, y) {
    this.text(words, x, y, { fill: "none", ...this.lines() });
  }

  measureText(words) {
    this.ruler.font = this.font;
    return this.ruler.measureText(words);
  }

  /** Attributes of a stroke. */
  lines() {
    return {
      ...this.paint("stroke", this.strokeStyle),
      "stroke-width": tidy(this.lineWidth),
      ...(this.lineJoin === "miter" ? {} : { "stroke-linejoin": this.lineJoin }),
      ...(this.lineCap === "butt" ? {} : { "stroke-linecap": this.lineCap }),
      ...(this.dash.length ? { "stroke-dasharray": this.dash.join(" ") } : {}),
    };
  }

  /** Attributes of a colour or a hatch; `kind` is `fill` or `stroke`. */
  paint(kind, style) {
    const [colour, alpha] = style.hatch ? [this.hatch(style.hatch), 1] : plainColour(style);
    const opacity = tidy(alpha * this.globalAlpha, 3);
    return { [kind]: colour, ...(opacity < 1 ? { [`${kind}-opacity`]: opacity } : {}) };
  }

  hatch({ id, ground, line }) {
    const known = this.defs.querySelector(`#${id}`);
    if (!known) drawHatch(this.defs, id, { fill: plainColour(ground)[0] }, { fill: plainColour(line)[0] });
    return `url(#${id})`;
  }

  text(words, x, y, attributes) {
    if (!Number.isFinite(x + y)) return;
    const [, weight, size, family] = /^(\S+) (\S+)px (.+)$/.exec(this.font);
    const anchor = { left: "start", center: "middle", right: "end" }[this.textAlign];
    this.add("text", {
      x: tidy(x), y: tidy(y), "font-weight": weight, "font-size": size, "font-family": family, "text-anchor": anchor, ...attributes,
    }, words);
  }

  add(tag, attributes, words) {
    draw(this.layer, tag, this.transform ? { transform: this.transform, ...attributes } : attributes, words);
  }

  /** The text of the document, with a title for screen readers. */
  written(title) {
    const { root, width, height } = this;
    setAll(root, { width, height, viewBox: `0 0 ${width} ${height}` });
    draw(draw(this.defs, "clipPath", { id: "page" }), "rect", { width, height });
    root.prepend(draw(null, "title", {}, title));
    return new XMLSerializer().serializeToString(root);
  }
}

/** Paints symbols as paths where the screen has stamps. */
class Pen extends Brush {
  stamp(name, classes, place, angle, size, selected) {
    this.symbol(name, classes, place, angle, size, { selected });
  }
}

/** The data of a path. A `Path2D` cannot be read. */
function dataOf(path) {
  if (path instanceof Path) return path.written;
  throw new TypeError("only a Path can be written as SVG");
}

function setAll(element, attributes) {
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
}

/** A computed colour as `#rrggbb`, which every reader of SVG understands, and its alpha. */
function plainColour(colour) {
  const [, numbers] = /^rgba?\((.*)\)$/.exec(colour) ?? [];
  if (!numbers) return [colour, 1];
  const [r, g, b, alpha = 1] = numbers.split(/[ ,/]+/).map(Number);
  return [`#${[r, g, b].map((x) => Math.round(x).toString(16).padStart(2, "0")).join("")}`, alpha];
}
