// Shapes in pixels: the symbols of the drawing model, and arrows whose size depends on a load. y points down, as on the page.

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

/** Paints a symbol of the drawing model, lying along x, into a group. */
function drawSymbol(group, symbol) {
  const [, , strokes] = data.drawing.shapes[symbol];
  for (const [kind, d] of strokes) draw(group, "path", { d, class: kind });
}

/** Path data of a spring of this length along x. */
function spring(length) {
  return `M${data.drawing.spring.map(([x, y]) => `${(x * length).toFixed(2)} ${y}`).join("L")}`;
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
