// Shapes in pixels: the symbols of the drawing model, and arrows whose size depends on a load. y points down, as on the page.

/** A path that is painted, and from which SVG can be written: its parts are kept. As a canvas, it leaves out what is not finite. */
class Path extends Path2D {
  constructor(d = "") {
    super(d);
    this.parts = d ? [d] : [];
  }

  moveTo(x, y) {
    if (!Number.isFinite(x + y)) return;
    super.moveTo(x, y);
    this.parts.push("M", x, y);
  }

  lineTo(x, y) {
    if (!Number.isFinite(x + y)) return;
    super.lineTo(x, y);
    this.parts.push(this.parts.length ? "L" : "M", x, y);
  }

  /** Clockwise on the page, from one angle to another (rad). */
  arc(x, y, r, from, to) {
    if (!Number.isFinite(x + y + r + from + to)) return;
    super.arc(x, y, r, from, to);
    const turn = 2 * Math.PI;
    const sweep = to - from >= turn ? turn : (((to - from) % turn) + turn) % turn;
    const at = (angle) => [x + r * Math.cos(angle), y + r * Math.sin(angle)];
    this.parts.push(this.parts.length ? "L" : "M", ...at(from));
    // An arc of SVG that ends where it starts is empty, so each is written as two.
    for (const share of [0.5, 1]) this.parts.push("A", r, r, 0, 0, 1, ...at(from + share * sweep));
  }

  closePath() {
    super.closePath();
    this.parts.push("Z");
  }

  /** Path data of SVG. */
  get written() {
    return this.parts.map((part) => (typeof part === "string" ? part : tidy(part))).join(" ");
  }
}

// A part that is painted and not kept would be lacking in SVG.
for (const name of Object.getOwnPropertyNames(Path2D.prototype)) {
  if (Object.hasOwn(Path.prototype, name)) continue;
  Path.prototype[name] = () => {
    throw new TypeError(`a path has no ${name}: add it to Path`);
  };
}

/** A number with so many decimals at most. */
function tidy(x, decimals = 2) {
  return Number(x.toFixed(decimals));
}

/** An arrow along x from 0 to `length`, head included. */
function arrow(length, width = 3.2, head = 10) {
  const neck = Math.max(length - head, 0);
  const side = width / 2;
  const wing = Math.min(width * 1.6, head * 0.5) + 0.6;
  return `M0 ${-side}H${neck}V${-wing}L${length} 0L${neck} ${wing}V${side}H0Z`;
}

/** An arrow with two heads at its end, from 0 to `length` along x: a moment in space. */
function momentArrow(length, width = 2.6, head = 9) {
  const [tip, neck] = [Math.max(length, 0), Math.max(length - head, 0)];
  const start = Math.max(neck - 0.75 * head, 0);
  const side = width / 2;
  const wing = Math.min(width * 1.6, head * 0.5) + 0.6;
  return `M0 ${-side}H${start}V${-wing}L${neck} ${-side}V${-wing}L${tip} 0L${neck} ${wing}V${side}L${start} ${wing}V${side}H0Z`;
}

/** An arrow with two heads, from −`half` to `half` along x. */
function doubleArrow(half, width = 7, head = 13) {
  const [neck, side, wing] = [half - head, width / 2, width * 1.15];
  return `M${-half} 0L${-neck} ${-wing}V${-side}H${neck}V${-wing}L${half} 0L${neck} ${wing}V${side}H${-neck}V${wing}Z`;
}

/** A turning arrow about the origin: starts at the right, counter-clockwise for positive angles (rad). */
function turning(radius, angle, width = 2.6, head = 9) {
  const sense = Math.sign(angle) || 1;
  const sweep = Math.max(Math.min(Math.abs(angle), 5.2), head / radius);
  const end = sense * (sweep - head / radius);
  const at = (r, a) => `${(r * Math.cos(a)).toFixed(2)} ${(-r * Math.sin(a)).toFixed(2)}`;
  const [outer, inner] = [radius + width / 2, radius - width / 2];
  const large = Math.abs(end) > Math.PI ? 1 : 0;
  const [there, back] = sense > 0 ? [0, 1] : [1, 0];
  const wing = width * 1.3;
  return `M${at(outer, 0)}A${outer} ${outer} 0 ${large} ${there} ${at(outer, end)}`
    + `L${at(radius + width / 2 + wing, end)}L${at(radius, sense * sweep)}L${at(radius - width / 2 - wing, end)}`
    + `L${at(inner, end)}A${inner} ${inner} 0 ${large} ${back} ${at(inner, 0)}Z`;
}

/** Paints a symbol of the drawing model, lying along x, into a group of a legend. */
function drawSymbol(group, symbol) {
  const [, , strokes] = data.drawing.shapes[symbol];
  for (const [kind, d] of strokes) draw(group, "path", { d, class: kind });
}

/** Path of a spring between two places of the page. */
function springBetween(a, b) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(dx, dy);
  const path = new Path();
  data.drawing.spring.forEach(([x, y]) => path.lineTo(a[0] + dx * x - (dy / length) * y, a[1] + dy * x + (dx / length) * y));
  return path;
}

/** The outline at a distance round the corners of a convex polygon as `hull` orders them. */
function roundedHull(corners, radius) {
  const path = new Path();
  const n = corners.length;
  if (n === 1) path.arc(corners[0][0], corners[0][1], radius, 0, 2 * Math.PI);
  else {
    const normal = (a, b) => Math.atan2(a[0] - b[0], b[1] - a[1]);
    for (let k = 0; k < n; k += 1) {
      const [before, at, after] = [corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]];
      path.arc(at[0], at[1], radius, normal(before, at), normal(at, after));
    }
  }
  path.closePath();
  return path;
}

/** Convex hull of points of the page (Andrew 1979), in the sense from x to y. */
function hull(points) {
  const sorted = [...points].sort(([a, b], [c, d]) => a - c || b - d);
  const half = (all) => {
    const chain = [];
    for (const p of all) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) > (b[1] - a[1]) * (p[0] - a[0]) + 1e-9) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain;
  };
  const distinct = sorted.filter((p, k) => k === 0 || Math.hypot(p[0] - sorted[k - 1][0], p[1] - sorted[k - 1][1]) > 1e-6);
  if (distinct.length < 3) return distinct;
  const [there, back] = [half(distinct), half(distinct.reverse())];
  return [...there.slice(0, -1), ...back.slice(0, -1)];
}
