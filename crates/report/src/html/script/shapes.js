// Shapes in pixels: outlines of bodies, symbols of joints, arrows. y points down, as on the page.

/** Convex hull, without points on its sides. */
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1])
    .filter((p, k, all) => !k || p[0] !== all[k - 1][0] || p[1] !== all[k - 1][1]);
  if (sorted.length < 3) return sorted;
  const half = (list) => {
    const chain = [];
    for (const p of list) {
      while (chain.length > 1 && cross(chain.at(-2), chain.at(-1), p) <= 1e-9) chain.pop();
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.toReversed())];
}

function cross(a, b, c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/** Twice the area of a polygon. */
function doubleArea(corners) {
  return corners.reduce((sum, a, k) => {
    const b = corners[(k + 1) % corners.length];
    return sum + a[0] * b[1] - a[1] * b[0];
  }, 0);
}

/** Path data of a hull with a margin and round corners. */
function rounded(corners, r) {
  if (corners.length === 1) {
    const [x, y] = corners[0];
    return `M${x - r} ${y}a${r} ${r} 0 1 1 ${2 * r} 0a${r} ${r} 0 1 1 ${-2 * r} 0Z`;
  }
  const sides = corners.map((a, k) => {
    const b = corners[(k + 1) % corners.length];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const n = [(r * (b[1] - a[1])) / length, (-r * (b[0] - a[0])) / length];
    return [[a[0] + n[0], a[1] + n[1]], [b[0] + n[0], b[1] + n[1]]];
  });
  const at = ([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`;
  const turns = sides.map(([a, b], k) => `${k ? `A${r} ${r} 0 0 1 ` : "M"}${at(a)}L${at(b)}`);
  return `${turns.join("")}A${r} ${r} 0 0 1 ${at(sides[0][0])}Z`;
}

/** An arrow along x from 0 to `length`, head included. */
function arrow(length, width = 3.2, head = 10) {
  const neck = Math.max(length - head, 0);
  const side = width / 2;
  const wing = Math.min(width * 1.6, head * 0.5) + 0.6;
  return `M0 ${-side}H${neck}V${-wing}L${length} 0L${neck} ${wing}V${side}H0Z`;
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

/** A spring of this length along x. */
function zigzag(length) {
  const [coils, end] = [6, Math.min(10, length * 0.15)];
  const step = (length - 2 * end) / (2 * coils);
  let d = `M0 0H${end.toFixed(2)}`;
  for (let k = 0; k < 2 * coils; k += 1) {
    d += `L${(end + (k + 0.5) * step).toFixed(2)} ${k % 2 ? 6 : -6}`;
  }
  return `${d}L${(length - end).toFixed(2)} 0H${length.toFixed(2)}`;
}

/** Draws what a joint leaves free, lying along x, into a group. */
function drawSymbol(group, symbol) {
  const box = (x, y, r) => draw(group, "rect", { x: -x, y: -y, width: 2 * x, height: 2 * y, rx: r, class: "mark" });
  switch (symbol) {
    case "weld":
      box(6.5, 6.5, 0);
      draw(group, "path", { d: "M-6.5-6.5L6.5 6.5M-6.5 6.5L6.5-6.5", class: "thin" });
      break;
    case "block":
      box(12, 7.5, 1.5);
      break;
    case "slot":
      draw(group, "rect", { x: -18, y: -7, width: 36, height: 14, rx: 7, class: "groove" });
      draw(group, "circle", { r: 5, class: "mark" });
      break;
    case "edge":
      box(17, 4.4, 2.5);
      break;
    case "rotation":
      draw(group, "circle", { r: 8.5, class: "mark" });
      draw(group, "path", { d: turning(4, 4.4, 1.2, 4), class: "thin" });
      break;
    case "push":
      draw(group, "path", { d: doubleArrow(19, 5, 10), transform: "translate(0 19)", class: "mark" });
      break;
    case "turn":
      draw(group, "path", { d: turning(13, 4.2, 4, 9), class: "mark" });
      break;
    case "rod":
      draw(group, "circle", { r: 4.5, class: "mark" });
      break;
    default:
      draw(group, "circle", { r: 6.2, class: "mark" });
  }
}

/** The ground below a point. */
function drawFoot(group) {
  draw(group, "path", { d: "M0 0L-9 14H9Z", class: "foot" });
  draw(group, "path", { d: "M-15 14H15M-9 14l-5 6M-3 14l-5 6M3 14l-5 6M9 14l-5 6M15 14l-5 6", class: "foot" });
}

/** Hatches of one line style for each verdict; colours are those of the style sheet. */
function defineHatches(svg) {
  const defs = draw(svg, "defs");
  for (const [id, pitch] of [["hatch", 4], ["hatch-wide", 6]]) {
    const pattern = draw(defs, "pattern", {
      id, width: pitch, height: pitch, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)",
    });
    draw(pattern, "rect", { width: pitch, height: pitch, class: "hatch-ground" });
    draw(pattern, "rect", { width: pitch * 0.45, height: pitch, class: "hatch-line" });
  }
}
