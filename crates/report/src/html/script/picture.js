// The mechanism to scale, moved along the run. Symbols keep their size in pixels; bodies, grid and traces are to scale.

const FLESH = 20;
const RIM = 22.4;
const ARROW_LONG = 95;
const MOVED_FAR = 2.2;
const AXIS = 36;
const TRACE_POINTS = 600;
const SMALLEST = 2e-3;

class Picture {
  /** @param {SVGSVGElement} svg */
  constructor(svg, { onJoint, onBody }) {
    this.svg = svg;
    this.show = { names: joints.length + bodies.length + data.drawing.markers.length <= 60, forces: true, freedom: true, grid: true, centres: true, follow: true };
    this.arrowScale = 1;
    this.traced = new Set();
    this.zoom = 1;
    this.shift = [0, 0];
    this.sites = joints.map((joint) => ({
      joint,
      place: placeFinder(joint.site.place),
      end: joint.site.end ? placeFinder(joint.site.end) : null,
      heading: headingFinder(joint.site.axis),
      axis: isGuided(joint.site.symbol) ? null : axisFinder(joint.site.axis),
    }));
    this.forces = data.drawing.forces.map((force) => ({ force }));
    this.measure();
    defineHatches(svg);
    this.layers = Object.fromEntries(
      ["grid", "traces", "bodies", "rails", "feet", "springs", "symbols", "markers", "freedom", "arrows", "names", "scale"]
        .map((name) => [name, draw(svg, "g", { class: name })]),
    );
    this.build(onJoint, onBody);
    this.listen();
    new ResizeObserver(() => this.resize()).observe(svg);
    this.resize();
  }

  /** Extents of the mechanism at one instant, and of the whole run. */
  measure() {
    const probes = Math.min(frameCount, 48);
    const whole = [[Infinity, -Infinity], [Infinity, -Infinity]];
    this.size = [1e-9, 1e-9];
    for (let p = 0; p < probes; p += 1) {
      const k = Math.round((p * (frameCount - 1)) / Math.max(probes - 1, 1));
      const box = this.boxAt(instantAt(times[k]));
      for (const axis of [0, 1]) {
        this.size[axis] = Math.max(this.size[axis], box[axis][1] - box[axis][0]);
        whole[axis][0] = Math.min(whole[axis][0], box[axis][0]);
        whole[axis][1] = Math.max(whole[axis][1], box[axis][1]);
      }
    }
    const finite = whole.flat().every(Number.isFinite);
    this.whole = finite ? whole : [[0, 1], [0, 1]];
    const span = this.whole.map(([a, b]) => b - a);
    const far = Math.hypot(...span) > MOVED_FAR * Math.hypot(...this.size);
    const grounded = data.drawing.sites.some((s) => s.grounded);
    const visible = Math.hypot(...this.size) > SMALLEST * Math.hypot(...span);
    this.travels = far && visible && !grounded;
    if (Math.max(...span) < 1e-9) this.whole = this.whole.map(([a, b]) => [(a + b) / 2 - 0.5, (a + b) / 2 + 0.5]);
  }

  /** Extent of all points at an instant. */
  boxAt(instant) {
    const box = [[Infinity, -Infinity], [Infinity, -Infinity]];
    const poses = posesAt(instant);
    const take = (p) => [0, 1].forEach((axis) => {
      box[axis][0] = Math.min(box[axis][0], p[axis]);
      box[axis][1] = Math.max(box[axis][1], p[axis]);
    });
    for (const body of bodies) {
      const pose = poses.of(body.index);
      take([pose.x, pose.y]);
      body.outline.forEach((p) => take(pointOn(pose, p)));
    }
    for (const site of this.sites) {
      take(site.place(poses, instant));
      for (const [b, r] of site.joint.site.wheels) {
        const { x, y } = poses.of(b);
        [[x - r, y - r], [x + r, y + r]].forEach(take);
      }
    }
    for (const { b, p } of data.drawing.markers) take(pointOn(poses.of(b), p));
    for (const { points } of data.drawing.forces) points.forEach(([b, p]) => take(pointOn(poses.of(b), p)));
    return box;
  }

  build(onJoint, onBody) {
    const { layers } = this;
    this.bodyGroups = bodies.map((body) => {
      const group = draw(layers.bodies, "g", { class: `body b${body.index % 6}`, tabindex: "-1" });
      draw(group, "title", {}, body.name);
      group.addEventListener("click", () => onBody(body.index));
      const hull = draw(group, "g", { class: "hull" });
      const [rim, flesh] = ["rim", "flesh"].map((kind) => draw(hull, "path", { class: kind }));
      const centre = draw(group, "g");
      drawSymbol(centre, "centre");
      return { group, rim, flesh, centre };
    });
    for (const site of this.sites) {
      const { joint } = site;
      const { symbol, grounded } = joint.site;
      const guided = isGuided(symbol);
      site.rail = guided ? draw(layers.rails, "path", { class: "rail" }) : null;
      site.foot = grounded && !guided ? draw(layers.feet, "g") : null;
      if (site.foot) drawSymbol(site.foot, "foot");
      site.wheels = joint.site.wheels.map(([body, radius]) => ({ body, radius, circle: draw(layers.rails, "circle", { class: "wheel" }) }));
      site.line = site.axis ? draw(layers.rails, "path", { class: "rail" }) : null;
      site.rod = symbol === "rod" ? draw(layers.symbols, "path", { class: `rod ${joint.verdict}` }) : null;
      site.group = draw(layers.symbols, "g", { class: `site ${joint.verdict}` });
      draw(site.group, "title", {}, `${joint.name} (${joint.type}): reaction ${joint.verdict.replace("_", " ")}`);
      drawSymbol(site.group, symbol);
      site.twin = symbol === "rod" ? draw(layers.symbols, "g", { class: `site ${joint.verdict}` }) : null;
      if (site.twin) drawSymbol(site.twin, symbol);
      site.group.addEventListener("click", () => onJoint(joint.index));
      site.arrow = draw(layers.arrows, "path", { class: `force ${joint.verdict}` });
      site.torque = draw(layers.arrows, "path", { class: `force ${joint.verdict}` });
      site.free = [0, 1, 2].map(() => draw(layers.freedom, "path", { class: "free" }));
      site.name = draw(layers.names, "text", { class: `name ${joint.verdict}` }, joint.name);
    }
    for (const f of this.forces) {
      const kind = ["couple", "load", "spring"][Math.min(f.force.points.length, 2)];
      f.kind = kind;
      f.feet = f.force.points.map(([b]) => (b < 0 ? draw(layers.feet, "g") : null));
      f.feet.filter(Boolean).forEach((foot) => drawSymbol(foot, "foot"));
      f.group = draw(layers.springs, "g");
      draw(f.group, "title", {}, `${f.force.name} (${f.force.type})`);
      if (kind === "spring") f.path = draw(f.group, "path", { class: "spring" });
      else drawSymbol(f.group, kind);
    }
    this.markers = data.drawing.markers.map((marker) => {
      const group = draw(layers.markers, "g");
      draw(group, "title", {}, marker.name);
      drawSymbol(group, "marker");
      return { marker, group, name: draw(layers.names, "text", { class: "name body-name" }, marker.name) };
    });
    this.bodyNames = bodies.map((body) => draw(layers.names, "text", { class: "name body-name" }, body.name));
    this.large = this.largeLoads();
  }

  /** Large force and torque among all reactions of the run; few are larger. */
  largeLoads() {
    const [forces, torques] = [[], []];
    for (const { wrench } of joints) {
      if (!wrench) continue;
      for (let k = 0; k < frameCount; k += Math.max(frameCount >> 7, 1)) {
        const at = wrench.map((values) => values[k]);
        forces.push(Math.hypot(...at.slice(0, FORCES)));
        torques.push(Math.hypot(...at.slice(FORCES)));
      }
    }
    const large = (values) => {
      const known = values.filter((x) => x > 0).sort((a, b) => a - b);
      return known[Math.floor(0.97 * (known.length - 1))] ?? 0;
    };
    return { force: large(forces), torque: large(torques) };
  }

  /** Page and scale from the size of the window, the zoom and what is to be seen. */
  resize() {
    const width = Math.max(this.svg.clientWidth, 200);
    const height = Math.max(this.svg.clientHeight, 200);
    this.page = [width, height];
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const follows = this.travels && this.show.follow;
    const span = follows ? this.size.map((x) => 1.04 * x) : this.whole.map(([a, b]) => b - a);
    const room = [width - 130, height - 110];
    this.base = Math.min(room[0] / Math.max(span[0], 1e-12), room[1] / Math.max(span[1], 1e-12));
    this.scale = this.base * this.zoom;
    this.symbolScale = this.roomForSymbols();
    this.shape();
    this.placeNames(clock.t);
    this.moveTo(clock.t);
  }

  /** Symbols shrink where half of them stand closer together than they are large. */
  roomForSymbols() {
    const instant = instantAt(tFirst);
    const poses = posesAt(instant);
    const places = this.sites.map((site) => site.place(poses, instant));
    const nearest = places.map(([x, y]) => {
      const far = places.map(([u, v]) => Math.hypot(u - x, v - y) * this.scale).filter((d) => d > 1e-6 * this.page[0]);
      return Math.min(...far);
    }).filter(Number.isFinite).sort((a, b) => a - b);
    const typical = nearest[nearest.length >> 1] ?? Infinity;
    return Math.min(Math.max(typical / 30, 0.2), 1);
  }

  /** Outlines for the present scale. */
  shape() {
    bodies.forEach((body, k) => {
      const { rim, flesh, centre } = this.bodyGroups[k];
      for (const [path, width] of [[rim, RIM], [flesh, FLESH]]) path.style.strokeWidth = width * this.symbolScale;
      if (!view) this.outline(k, body.outline);
      centre.setAttribute("transform", `scale(${this.symbolScale})`);
    });
    this.layers.bodies.append(...data.drawing.order.map((k) => this.bodyGroups[k].group));
    for (const { radius, circle } of this.sites.flatMap((site) => site.wheels)) circle.setAttribute("r", radius * this.scale);
    for (const site of this.sites) if (site.rail) site.rail.setAttribute("d", this.railOf(site));
    this.traces = [...this.traced].map((k) => this.traces?.find((t) => t.index === k) ?? this.newTrace(k));
  }

  /** Draws a body with these corners (m) about its centre. */
  outline(k, points) {
    const corners = points.map(([x, y]) => `${(x * this.scale).toFixed(2)} ${(-y * this.scale).toFixed(2)}`);
    const { rim, flesh } = this.bodyGroups[k];
    for (const path of [rim, flesh]) path.setAttribute("d", `M${corners.join("L")}L${corners[0]}Z`);
  }

  /** A guide, as long as its block travels. */
  railOf(site) {
    let [low, high] = [0, 0];
    for (let k = 0; k < frameCount; k += Math.max(frameCount >> 6, 1)) {
      const instant = instantAt(times[k]);
      const poses = posesAt(instant);
      const [p, e, a] = [site.place(poses, instant), site.end(poses, instant), site.heading(poses, instant)];
      const along = (e[0] - p[0]) * Math.cos(a) + (e[1] - p[1]) * Math.sin(a);
      [low, high] = [Math.min(low, along), Math.max(high, along)];
    }
    const [from, to] = [low * this.scale - 30, high * this.scale + 30];
    let d = `M${from} 0H${to}`;
    if (site.joint.site.grounded) {
      d += `M${from} 11H${to}`;
      for (let x = from + 6; x <= to; x += 8) d += `M${x} 11l-5 6`;
    }
    return d;
  }

  camera(instant) {
    let middle = this.whole.map(([a, b]) => (a + b) / 2);
    if (this.travels && this.show.follow) {
      const box = this.boxAt(instant);
      middle = box.map(([a, b]) => (a + b) / 2);
    }
    const [w, h] = this.page;
    return {
      origin: [w / 2 - middle[0] * this.scale + this.shift[0], h / 2 + middle[1] * this.scale + this.shift[1]],
    };
  }

  /** Draws an instant. */
  moveTo(t) {
    const instant = instantAt(t);
    const poses = posesAt(instant);
    const { origin } = this.camera(instant);
    const { scale } = this;
    const toPage = ([x, y]) => [origin[0] + x * scale, origin[1] - y * scale];
    this.drawGrid(origin);
    bodies.forEach((body, k) => {
      const pose = poses.of(k);
      const [x, y] = toPage([pose.x, pose.y]);
      const turn = (-pose.angle * 180) / Math.PI;
      if (view) this.outline(k, hull(body.outline.map((p) => pose.rows.map((row) => dot(row, p)))));
      this.bodyGroups[k].group.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)}) rotate(${turn.toFixed(3)})`);
      this.bodyNames[k].setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
    });
    for (const site of this.sites) this.moveSite(site, poses, instant, toPage);
    for (const f of this.forces) this.moveForce(f, poses, toPage);
    for (const { marker, group, name } of this.markers) {
      const [x, y] = toPage(pointOn(poses.of(marker.b), marker.p));
      for (const element of [group, name]) element.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
    }
    for (const trace of this.traces) this.moveTrace(trace, poses, instant, origin);
  }

  moveSite(site, poses, instant, toPage) {
    const place = toPage(site.place(poses, instant));
    const end = site.end ? toPage(site.end(poses, instant)) : place;
    const at = site.joint.site.symbol === "rod" ? place : end;
    const angle = (-site.heading(poses, instant) * 180) / Math.PI;
    const put = (element, [x, y], turn = 0, size = 1) => element?.setAttribute(
      "transform",
      `translate(${x.toFixed(2)} ${y.toFixed(2)}) rotate(${turn.toFixed(2)})${size === 1 ? "" : ` scale(${size.toFixed(3)})`}`,
    );
    put(site.group, at, angle, this.symbolScale);
    put(site.rail, place, angle);
    put(site.foot, at, 0, this.symbolScale);
    put(site.twin, end, 0, this.symbolScale);
    site.rod?.setAttribute("d", `M${place}L${end}`);
    put(site.name, at);
    if (site.line) {
      const [dx, dy] = site.axis(poses, instant).map((x) => AXIS * this.symbolScale * x);
      site.line.setAttribute("d", `M${at[0] - dx} ${at[1] + dy}L${at[0] + dx} ${at[1] - dy}`);
    }
    for (const { body, circle } of site.wheels) put(circle, toPage(centreOf(poses, body)));
    this.moveLoads(site, place, instant, put);
  }

  /** What tells where the symbol of a joint stands: blocks are where they slide to. */
  shownAt(site) {
    return site.joint.site.symbol === "rod" ? site.place : site.end ?? site.place;
  }

  /** Arrows of what is determined, hatched ones of what is free. */
  moveLoads(site, place, instant, put) {
    const { joint } = site;
    let d = "";
    let torque = "";
    if (joint.wrench && this.show.forces) {
      const [fx, fy, m] = this.shown(joint, instant);
      const size = Math.hypot(fx, fy);
      const share = Math.min(size / (this.large.force || 1), 1.6);
      const length = this.arrowScale * ARROW_LONG * share;
      if (length > 1.5) {
        d = arrow(length, 3.2, Math.min(10, length));
        put(site.arrow, place, (-Math.atan2(fy, fx) * 180) / Math.PI);
      }
      const turn = m / (this.large.torque || 1);
      if (Math.abs(turn) > 0.01) {
        torque = turning(17, 4.4 * Math.min(this.arrowScale, 1) * turn);
        put(site.torque, place);
      }
    }
    site.arrow.setAttribute("d", d);
    site.torque.setAttribute("d", torque);
    this.moveFreedom(site, place, instant, put);
  }

  /** The determined force in the picture, and the torque in the plane: one in space has no picture. */
  shown(joint, instant) {
    if (!view) return this.determined(joint, instant);
    const known = (name) => verdictOf(joint, name) === "unique";
    const force = joint.wrench.slice(0, FORCES).map((values, k) => (known(COMPONENTS[k]) ? linear(values, instant) : 0));
    return [...flat(force), 0];
  }

  /** The part of a reaction in the plane that no choice changes; NaN where nothing is known. */
  determined(joint, instant) {
    const [fx, fy, m] = joint.wrench.map((w) => linear(w, instant));
    if (joint.verdict === "unique") return [fx, fy, m];
    const { freedom } = joint;
    if (!freedom) return [0, 0, 0];
    const known = verdictOf(joint, "T") === "unique" ? m : 0;
    const angle = linear(freedom.angle, instant);
    if (freedom.plane) return [0, 0, known];
    if (Number.isNaN(angle)) return [fx, fy, known];
    const along = fx * Math.cos(angle) + fy * Math.sin(angle);
    return [fx - along * Math.cos(angle), fy - along * Math.sin(angle), known];
  }

  moveFreedom(site, place, instant, put) {
    const freedom = this.show.freedom && !view ? site.joint.freedom : null;
    const angle = freedom ? linear(freedom.angle, instant) : NaN;
    const turn = (-angle * 180) / Math.PI;
    const isFree = Number.isFinite(angle);
    const shapes = [isFree ? doubleArrow(46) : "", isFree && freedom.plane ? doubleArrow(46) : "", freedom?.components[2] ? turning(25, 4.9, 6, 12) : ""];
    shapes.forEach((d, k) => {
      site.free[k].setAttribute("d", d);
      if (d) put(site.free[k], place, [turn, turn + 90, 0][k], this.symbolScale);
    });
  }

  moveForce(f, poses, toPage) {
    const points = f.force.points.map(([b, p]) => toPage(pointOn(poses.of(b), p)));
    f.feet.forEach((foot, k) => foot?.setAttribute("transform", `translate(${points[k]})`));
    if (f.kind === "spring") {
      const [a, b] = points;
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
      const turn = (Math.atan2(b[1] - a[1], b[0] - a[0]) * 180) / Math.PI;
      f.path.setAttribute("d", length > 4 ? spring(length) : data.drawing.shapes["short spring"][2][0][1]);
      f.group.setAttribute("transform", `translate(${a}) rotate(${turn})`);
      return;
    }
    const body = f.force.bodies.findLast((b) => b >= 0) ?? -1;
    const at = points[0] ?? toPage(centreOf(poses, body));
    f.group.setAttribute("transform", `translate(${at}) scale(${this.symbolScale})`);
  }

  /** Lines at round numbers, and a bar that tells their distance. */
  drawGrid(origin) {
    const [w, h] = this.page;
    const { grid, scale } = this.layers;
    const step = roundStep((view ? 20 : 64) / this.scale);
    const pitch = step * this.scale;
    let d = "";
    if (this.show.grid && pitch > 8 && !view) {
      for (let x = ((origin[0] % pitch) + pitch) % pitch; x < w; x += pitch) d += `M${x.toFixed(1)} 0V${h}`;
      for (let y = ((origin[1] % pitch) + pitch) % pitch; y < h; y += pitch) d += `M0 ${y.toFixed(1)}H${w}`;
    }
    this.gridPath ??= draw(grid, "path", {});
    this.gridPath.setAttribute("d", d);
    if (this.barPitch === pitch && this.barPage === h) return;
    [this.barPitch, this.barPage] = [pitch, h];
    scale.replaceChildren();
    if (view) {
      this.drawAxes(step);
      return;
    }
    draw(scale, "path", { d: `M18 ${h - 22}v8h${pitch.toFixed(1)}v-8` });
    draw(scale, "text", { x: 18 + pitch / 2, y: h - 20, "text-anchor": "middle" }, this.lengthInWords(step));
  }

  /** The axes of the ground in a corner, each of a round length. */
  drawAxes(step) {
    const { scale } = this.layers;
    const [x0, y0] = [46, this.page[1] - 60];
    ["x", "y", "z"].forEach((name, k) => {
      const [right, up] = view.map((row) => row[k]);
      const to = (pixels) => [x0 + pixels * right, y0 - pixels * up];
      const arm = step * this.scale;
      draw(scale, "path", { d: `M${x0} ${y0}L${to(arm)}` });
      const [x, y] = to(arm + 12);
      draw(scale, "text", { x, y: y + 4, "text-anchor": "middle" }, name);
    });
    draw(scale, "text", { x: 18, y: this.page[1] - 14 }, `axes ${this.lengthInWords(step)}`);
  }

  lengthInWords(x) {
    const [unit, name] = [[1e3, "km"], [1, "m"], [1e-3, "mm"], [1e-6, "µm"]].find(([u]) => x >= 0.999 * u) ?? [1, "m"];
    const metres = x >= 0.0999 && x < 1 ? [1, "m"] : [unit, name];
    return `${spoken(x / metres[0])} ${metres[1]}`;
  }

  /** Shows or hides the path of a track. */
  trace(index, wanted) {
    if (wanted) this.traced.add(index);
    else this.traced.delete(index);
    const gone = this.traces?.filter((t) => !this.traced.has(t.index)) ?? [];
    gone.forEach((t) => [t.whole, t.past].forEach((path) => path.remove()));
    this.traces = [...this.traced].map((k) => this.traces.find((t) => t.index === k) ?? this.newTrace(k));
    this.moveTo(clock.t);
  }

  newTrace(index) {
    const colour = `c${index % 7}`;
    const parts = Math.max(1, Math.ceil(TRACE_POINTS / frameCount));
    const count = (frameCount - 1) * parts + 1;
    const between = (k) => {
      const [frame, part] = [Math.floor(k / parts), k % parts];
      return part ? times[frame] + (part / parts) * (times[frame + 1] - times[frame]) : times[frame];
    };
    const instants = Array.from({ length: count }, (_, k) => instantAt(between(k)));
    const { b, p } = tracks[index];
    return {
      index,
      instants,
      points: instants.map((instant) => pointOn(poseOf(b, instant), p)),
      whole: draw(this.layers.traces, "path", { class: `trace whole ${colour}` }),
      past: draw(this.layers.traces, "path", { class: `trace ${colour}` }),
    };
  }

  moveTrace(trace, poses, instant, origin) {
    const { b, p } = tracks[trace.index];
    const at = ([px, py]) => `${(origin[0] + px * this.scale).toFixed(1)} ${(origin[1] - py * this.scale).toFixed(1)}`;
    const points = trace.points.map(at);
    trace.whole.setAttribute("d", `M${points.join("L")}`);
    const passed = trace.instants.findLastIndex((i) => i.t <= instant.t) + 1;
    const now = at(pointOn(poses.of(b), p));
    trace.past.setAttribute("d", `M${[...points.slice(0, passed), now].join("L")}`);
  }

  /** Gives each name a side of its place where it covers nothing at this time. */
  placeNames(t = tFirst) {
    this.layers.names.style.display = this.show.names ? "" : "none";
    const instant = instantAt(t);
    const poses = posesAt(instant);
    const { origin } = this.camera(instant);
    const toPage = ([x, y]) => [origin[0] + x * this.scale, origin[1] - y * this.scale];
    const taken = this.sites.map((site) => {
      const [x, y] = toPage(this.shownAt(site)(poses, instant));
      return [x - 11, y - 11, x + 11, y + 11];
    });
    const put = (text, [x, y], size) => {
      const width = text.getComputedTextLength?.() || 0.65 * size * text.textContent.length;
      const spots = [14, 24, 36].flatMap((r) => [[r, -r * 0.6], [-r - width, -r * 0.6], [r, r + 4], [-r - width, r + 4], [-width / 2, -r - 3], [-width / 2, r + 12]]);
      const boxes = spots.map(([dx, dy]) => [x + dx, y + dy - size, x + dx + width, y + dy + 3]);
      const outside = (box) => Math.max(-box[0], 0, box[2] - this.page[0]) * size;
      const costs = boxes.map((box) => taken.reduce((sum, other) => sum + overlap(box, other), outside(box)));
      const best = costs.indexOf(Math.min(...costs));
      text.setAttribute("x", spots[best][0].toFixed(1));
      text.setAttribute("y", spots[best][1].toFixed(1));
      taken.push(boxes[best]);
    };
    for (const site of this.sites) put(site.name, toPage(this.shownAt(site)(poses, instant)), 13);
    bodies.forEach((_, k) => {
      const pose = poses.of(k);
      put(this.bodyNames[k], toPage([pose.x, pose.y]), 12);
    });
    for (const { marker, name } of this.markers) put(name, toPage(pointOn(poses.of(marker.b), marker.p)), 12);
    this.svg.classList.toggle("no-centres", !this.show.centres);
  }

  /** Marks the joint whose reaction is shown. */
  select(index) {
    this.sites.forEach((site) => site.group.classList.toggle("selected", site.joint.index === index));
  }

  /** Wheel with Ctrl, or two buttons, zoom; dragging moves; a double click goes back. */
  listen() {
    this.svg.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      this.zoomBy(Math.exp(-event.deltaY * 0.002));
    }, { passive: false });
    this.svg.addEventListener("pointermove", (event) => {
      if (!(event.buttons & 1)) return;
      this.shift = [this.shift[0] + event.movementX, this.shift[1] + event.movementY];
      this.moveTo(clock.t);
    });
    this.svg.addEventListener("dblclick", () => this.zoomBy(0));
  }

  /** Zooms about the middle; 0 goes back to the beginning. */
  zoomBy(factor) {
    if (factor === 0) this.shift = [0, 0];
    else this.shift = this.shift.map((x) => x * factor);
    this.zoom = factor === 0 ? 1 : Math.min(Math.max(this.zoom * factor, 0.1), 200);
    this.resize();
  }
}

/** The centre of mass of a body in the picture. */
function centreOf(poses, body) {
  const { x, y } = poses.of(body);
  return [x, y];
}

/** Convex hull of points in the picture, counter-clockwise (Andrew 1979). */
function hull(points) {
  const sorted = [...points].sort(([a, b], [c, d]) => a - c || b - d);
  const half = (all) => {
    const chain = [];
    for (const p of all) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) > (b[1] - a[1]) * (p[0] - a[0])) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain;
  };
  if (sorted.length < 3) return sorted;
  return [...half(sorted).slice(0, -1), ...half(sorted.reverse()).slice(0, -1)];
}

/** Whether a symbol slides on a rail. */
function isGuided(symbol) {
  return symbol === "block" || symbol === "slot";
}

/** Common area of two boxes. */
function overlap(a, b) {
  const w = Math.min(a[2], b[2]) - Math.max(a[0], b[0]);
  const h = Math.min(a[3], b[3]) - Math.max(a[1], b[1]);
  return w > 0 && h > 0 ? w * h : 0;
}
