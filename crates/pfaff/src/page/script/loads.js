// Arrows: the determined parts of reactions, directions in which the model leaves them open, and the loads of a self-stress.

/** Arrows of what is free in the plane. */
const FREE_ARROW = new Path(doubleArrow(46));
const FREE_TURN = new Path(turning(25, 4.9, 6, 12));

/** A force in space as an arrow from a place, or a moment as an arrow with two heads; `size` in pixels is its length seen from the side. */
function addArrow(picture, layer, place, vector, size, look, isMoment = false) {
  const { camera, brush } = picture;
  const from = camera.project(place);
  const tip = camera.project(plus(place, unit(vector), size / camera.scale));
  const [dx, dy] = [tip[0] - from[0], tip[1] - from[1]];
  const length = Math.hypot(dx, dy);
  if (size < 1.5) return;
  picture.add(layer, picture.before((from[2] + tip[2]) / 2, FRONT + 6), () => {
    if (picture.isCrowd) {
      const [neck, head] = [Math.max(length - 8, 0), isMoment ? 4 : 3];
      brush.polygon(from, [dx, dy], [[0, -1], [neck, -1], [neck, -head], [length, 0], [neck, head], [neck, 1], [0, 1]], look.fill);
      return;
    }
    if (length < 6 && length < 0.4 * size) {
      // Seen from its end.
      const path = new Path();
      path.arc(from[0], from[1], 4, 0, 2 * Math.PI);
      brush.path(path, look);
      return;
    }
    const head = Math.min(10, length);
    brush.from(from, [dx, dy], isMoment ? momentArrow(length, 2.6, Math.min(9, 0.55 * length)) : arrow(length, 3.2, head), look, view && look.strokeFirst ? { width: 2 * look.width + 1 } : {});
  });
}

/** A moment about the upright of the plane as a turning arrow; `share` is relative to a large one. */
function addTurning(picture, layer, from, share, look) {
  const d = turning(17, 4.4 * Math.min(picture.arrowScale, 1) * share);
  picture.add(layer, 0, () => picture.brush.at(from[0], from[1], 0, 1, () => picture.brush.path(new Path(d), look)));
}

/** A wrench at a place, as arrows. */
function addWrench(picture, layer, place, wrench, large, look) {
  const share = (size, of) => Math.min(size / (of || 1), 1.6);
  const force = spatial(wrench.slice(0, FORCES));
  const size = norm(force);
  if (size > 0) addArrow(picture, layer, place, force, picture.arrowScale * ARROW_LONG * share(size, large.force), look);
  if (!view) {
    const turn = wrench[FORCES] / (large.torque || 1);
    if (Math.abs(turn) > 0.01) addTurning(picture, layer, picture.camera.project(place), turn, look);
    return;
  }
  const moment = wrench.slice(FORCES);
  const turn = share(norm(moment), large.torque);
  if (turn > 0.01) addArrow(picture, layer, place, moment, picture.arrowScale * MOMENT_LONG * turn, look, true);
}

/** Arrows of what is determined, hatched ones of what is free. */
function paintLoads(picture, site, { place, from, to }) {
  const { joint } = site;
  const { looks } = picture.brush;
  if (picture.firstOrder) {
    const wrench = picture.firstOrder.wrenches?.get(joint.index);
    if (!wrench) return;
    const { large } = picture.firstOrder;
    addWrench(picture, "arrows", place, wrench, large, looks.of(`force ${joint.verdict}`));
    addWrench(picture, "arrows", place, wrench.map((x) => -x), large, looks.of("reply"));
    return;
  }
  if (picture.show.forces && joint.wrench) {
    addWrench(picture, "arrows", place, determined(joint, picture.instant), picture.large, looks.of(`force ${joint.verdict}`));
  }
  if (picture.show.freedom && joint.freedom) paintFreedom(picture, joint, place, from);
}

/** The part of a reaction that no choice changes; zero where nothing is known. */
function determined(joint, instant) {
  const at = (curves) => curves.map((w) => linear(w, instant));
  const values = at(joint.wrench);
  if (joint.verdict === "unique") return values;
  const { freedom } = joint;
  if (view || !freedom) return values.map((x) => (Number.isFinite(x) ? x : 0));
  // In the plane the part across the free direction is determined, whatever the axes.
  const [fx, fy] = at(chosenWrench(joint));
  const known = Number.isFinite(values[2]) ? values[2] : 0;
  const angle = linear(freedom.angle, instant);
  if (freedom.plane) return [0, 0, known];
  if (Number.isNaN(angle)) return [fx, fy, known];
  const along = fx * Math.cos(angle) + fy * Math.sin(angle);
  return [fx - along * Math.cos(angle), fy - along * Math.sin(angle), known];
}

/** In the plane the free direction of every joint; in space, where there may be six, those of the joint that is chosen. */
function paintFreedom(picture, joint, place, from) {
  const { brush, symbolScale, instant } = picture;
  const { freedom } = joint;
  const look = brush.looks.of("free");
  const put = (d, angle) => picture.add("freedom", picture.before(from[2], FRONT + 4), () => {
    brush.at(from[0], from[1], angle, symbolScale, () => brush.path(typeof d === "string" ? new Path(d) : d, look));
  });
  if (!view) {
    const angle = linear(freedom.angle, instant);
    if (Number.isFinite(angle)) {
      put(FREE_ARROW, -angle);
      if (freedom.plane) put(FREE_ARROW, -angle + Math.PI / 2);
    }
    if (freedom.components[2]) put(FREE_TURN, 0);
    return;
  }
  if (joint.index !== picture.selected) return;
  const inBody = freedom.in_body.filter(Boolean).length < freedom.components.filter(Boolean).length;
  const rows = inBody ? picture.poses.of(joint.site.bodies[0]).rows : UNTURNED;
  (inBody ? freedom.in_body : freedom.components).forEach((isFree, k) => {
    if (!isFree) return;
    const isMoment = k >= FORCES;
    const axis = rows.map((row) => row[k % FORCES]);
    const long = isMoment ? 30 : 46;
    const [dx, dy] = picture.camera.direction(axis);
    const seen = Math.hypot(dx, dy);
    if (seen < 0.15) return;
    const half = symbolScale * long * seen;
    put(isMoment ? twoHeads(half) : doubleArrow(half, 7, Math.min(13, half / 2)), Math.atan2(dy, dx));
  });
}

/** Four heads along x, two at each end: a moment that is free. */
function twoHeads(half, head = 9) {
  const side = (s) => `M${s * half} 0L${s * (half - head)} -6L${s * (half - head)} 6ZM${s * (half - head)} 0L${s * (half - 2 * head)} -6L${s * (half - 2 * head)} 6Z`;
  const long = Math.max(half - 2 * head, 0);
  return `${side(1)}${side(-1)}M${-long} -2H${long}V2H${-long}Z`;
}
