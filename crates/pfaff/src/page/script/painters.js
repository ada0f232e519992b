// What the picture paints: bodies, joints, loads, applied forces, markers, traces, grid and scale.

const FLESH = 20;
const RIM = 1.2;
const ARROW_LONG = 95;
const MOMENT_LONG = 70;
const AXIS = 36;
const RAIL = 30;
const TRACE_POINTS = 600;
/** In space: width of the bars of a body, of the colour of the page beside lines, and length of the pieces of long lines (px). */
const BAR = 8;
const HALO = 2.4;
const PIECE = 36;
/** How far symbols stand in front of their places, so that bars that end there do not hide them (px). */
const FRONT = 26;
/** How opaque the faces of a body in space are. */
const VEIL = 0.55;

/** A straight line in space in pieces, each at its own distance; `paint` gets the ends on the page and whether they are ends of the line. */
function addLine(picture, layer, a, b, paint, pixels = 0) {
  if (!view) {
    picture.add(layer, 0, () => paint(a, b, [true, true]));
    return;
  }
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  const deep = Math.abs(b[2] - a[2]) * picture.camera.scale;
  const most = picture.isCrowd ? 1 : 16;
  const count = Math.max(1, Math.min(most, Math.ceil(Math.min(length, 2 * deep) / PIECE)));
  const at = (s) => [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
  for (let k = 0; k < count; k += 1) {
    const near = a[2] + ((k + 0.5) / count) * (b[2] - a[2]);
    picture.add(layer, picture.before(near, pixels), () => paint(at(k / count), at((k + 1) / count), [k === 0, k === count - 1]));
  }
}

/** A point of the page a little before the second of two. */
function short(a, b, by) {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  const share = length > 2 * by ? by / length : 0.5;
  return [b[0] + share * (a[0] - b[0]), b[1] + share * (a[1] - b[1])];
}

/** A thin line in space with its halo. */
function addThin(picture, layer, a, b, look, { width = look.width, halo = HALO, pixels = 0 } = {}) {
  addLine(picture, layer, a, b, (from, to) => {
    picture.brush.line(from, to, look, { width, halo: view ? halo : 0 });
  }, pixels);
}

function paintBodies(picture) {
  if (view) picture.light = unit(plus(plus(picture.camera.towards, picture.camera.up, 0.8), picture.camera.right, -0.4));
  const { camera, poses, brush, symbolScale } = picture;
  const order = view ? bodies.map((b) => b.index) : data.drawing.order;
  for (const k of order) {
    const body = bodies[k];
    const pose = poses.of(k);
    const group = `body b${k % 6}`;
    const flesh = brush.looks.of(group, "hull", "flesh");
    const rim = brush.looks.of(group, "hull", "rim");
    const looks = { flesh: flesh.fill, rim: k === picture.hovered ? brush.looks.ink : rim.stroke };
    if (view) paintSolid(picture, body, pose, looks);
    else {
      const points = body.outline.map((p) => camera.project(pointOn(pose, p)));
      if (picture.isCrowd) {
        paintPlainly(picture, k, points, looks);
        continue;
      }
      const corners = hull(points);
      const path = roundedHull(corners, (FLESH / 2 + RIM / 2) * symbolScale);
      picture.targets.push({ body: k, path });
      picture.add("bodies", 0, () => {
        brush.path(path, { ...flesh, fill: looks.flesh, stroke: looks.rim, opacity: 0.9 }, { width: RIM * symbolScale });
      });
    }
    if (picture.show.centres) {
      const [x, y, near] = camera.project(pose.r);
      picture.add("bodies", picture.before(near, BAR), () => brush.symbol("centre", group, [x, y], 0, symbolScale));
    }
  }
}

/** A body among many in the plane: its outline in two strokes. */
function paintPlainly(picture, k, points, looks) {
  const { brush, symbolScale } = picture;
  const { context } = brush;
  picture.targets.push({ body: k, corners: points });
  const width = Math.max(FLESH * symbolScale, 1);
  picture.add("bodies", 0, () => {
    context.lineJoin = "round";
    context.lineCap = "round";
    context.beginPath();
    points.forEach((p) => context.lineTo(p[0], p[1]));
    if (points.length > 2) context.closePath();
    context.strokeStyle = looks.rim;
    context.lineWidth = width + 2 * RIM;
    context.stroke();
    context.strokeStyle = looks.flesh;
    context.lineWidth = width;
    context.stroke();
    if (points.length > 2) {
      context.fillStyle = looks.flesh;
      context.fill();
    }
  });
}

/** A body in space: bars along the edges of its hull that are seen, and its faces. */
function paintSolid(picture, { index, solid }, pose, looks) {
  const { camera, brush, symbolScale } = picture;
  const { context } = brush;
  const corners = solid.points.map((p) => camera.project(pointOn(pose, p)));
  picture.targets.push({ body: index, corners });
  const bar = (larger) => BAR * symbolScale * larger;
  const eye = camera.isPerspective ? plus(camera.focus, camera.towards.map((x) => x * camera.eye)) : null;
  const faces = solid.faces.map(({ ring, normal, isSheet }) => {
    const n = turnedBy(pose.rows, normal);
    const facing = eye ? dot3(n, unit(minus(eye, pointOn(pose, solid.points[ring[0]])))) : dot3(n, camera.towards);
    return { ring, n, isSeen: isSheet || facing > 0 };
  });
  for (const { ring, n } of faces.filter((f) => f.isSeen)) {
    // Behind all that is nearer than its farthest corner: what is painted over it by mistake is seen through it anyway.
    const near = Math.min(...ring.map((k) => corners[k][2]));
    // Light comes from above the left shoulder.
    const shade = 0.12 * (1 - Math.abs(dot3(n, picture.light)));
    picture.add("bodies", near, () => {
      const path = new Path();
      ring.forEach((k) => path.lineTo(corners[k][0], corners[k][1]));
      path.closePath();
      context.globalAlpha = VEIL;
      context.fillStyle = looks.flesh;
      context.fill(path);
      context.globalAlpha = shade;
      context.fillStyle = "#000";
      context.fill(path);
      context.globalAlpha = 1;
    });
  }
  const round = new Set();
  for (const { ends, faces: sides } of solid.edges) {
    if (sides.length && !sides.some((k) => faces[k].isSeen)) continue;
    const [a, b] = ends.map((k) => corners[k]);
    ends.forEach((k) => round.add(k));
    const wide = bar((a[3] + b[3]) / 2);
    if (picture.isCrowd) {
      // The halo waits until the picture rests.
      picture.add("bodies", (a[2] + b[2]) / 2, () => {
        const width = Math.max(wide, 1.5);
        if (!clock.playing) brush.stroke(a, b, brush.looks.page, width + 2);
        brush.stroke(a, b, looks.rim, width);
      });
      continue;
    }
    addLine(picture, "bodies", a, b, (from, to, [starts, stops]) => {
      const inset = wide / 2 + HALO + 1;
      paintBar(brush, from, to, wide, looks, [starts ? inset : 0, stops ? inset : 0]);
    });
  }
  if (picture.isCrowd && solid.edges.length) return;
  if (!solid.edges.length) round.add(0);
  for (const k of round) {
    const [x, y, near, larger] = corners[k];
    const radius = (solid.edges.length ? bar(larger) / 2 : 1.3 * bar(larger)) + RIM / 2;
    picture.add("bodies", near, () => {
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.fillStyle = looks.flesh;
      context.fill();
      context.strokeStyle = looks.rim;
      context.lineWidth = RIM;
      context.stroke();
    });
  }
}

/** A piece of a bar, kept apart from what is behind; the halo ends before the ends of the bar, where other bars begin. */
function paintBar(brush, a, b, wide, looks, insets) {
  const { context } = brush;
  const stroke = (from, to, colour, width) => {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    context.moveTo(from[0], from[1]);
    context.lineTo(to[0], to[1]);
    context.stroke();
  };
  context.lineCap = "butt";
  if (Math.hypot(b[0] - a[0], b[1] - a[1]) > insets[0] + insets[1]) {
    const from = insets[0] ? short(b, a, insets[0]) : a;
    const to = insets[1] ? short(a, b, insets[1]) : b;
    stroke(from, to, brush.looks.page, wide + 2 * RIM + 2 * HALO);
  }
  stroke(a, b, looks.rim, wide + 2 * RIM);
  // Pieces overlap a little, so that no seam is seen.
  stroke(short(b, a, -0.6), short(a, b, -0.6), looks.flesh, wide);
}

/** A joint or drive: its symbol, and what it slides on or turns about. */
function paintSite(picture, site) {
  const { camera, poses, instant, brush } = picture;
  const { joint } = site;
  const { symbol, grounded } = joint.site;
  const place = site.place(poses, instant);
  const end = site.end ? site.end(poses, instant) : place;
  const [from, to] = [camera.project(place), site.end ? camera.project(end) : null];
  const at = symbol === "rod" ? from : to ?? from;
  const axis = site.axis?.(poses, instant) ?? null;
  const [dx, dy] = axis ? camera.direction(axis) : [1, 0];
  const angle = Math.atan2(dy, dx);
  const size = picture.symbolScale * at[3];
  const classes = `site ${joint.verdict}`;
  const put = (name, group, spot, turn, before, options) => {
    if (picture.isCrowd) picture.add(name === "foot" ? "feet" : "symbols", before, () => brush.stamp(name, group, spot, turn, size, options.selected));
    else picture.add(name === "foot" ? "feet" : "symbols", before, () => brush.symbol(name, group, spot, turn, size, options));
  };
  site.shown = at;
  picture.targets.push({ joint: joint.index, at });
  for (const wheel of site.wheels) paintWheel(picture, wheel);
  if (site.isGuided) paintRail(picture, site, place, axis, from);
  else if (grounded) put("foot", "", at, 0, picture.before(at[2], 4), {});
  if (symbol === "rod") addThin(picture, "symbols", from, to, brush.looks.of(`rod ${joint.verdict}`), { pixels: 3 });
  if (axis && !site.isGuided && view) {
    const rail = brush.looks.of("rails", "rail");
    const arm = axis.map((x) => (x * AXIS * size) / camera.scale);
    const middle = symbol === "rod" ? place : end;
    if (picture.isCrowd) {
      const ends = [-1, 1].map((sign) => camera.project(plus(middle, arm, sign)));
      picture.add("rails", at[2], () => brush.stroke(...ends, rail.stroke, 1));
    } else for (const sign of [-1, 1]) addThin(picture, "rails", at, camera.project(plus(middle, arm, sign)), rail, { pixels: 2 });
  }
  const selected = joint.index === picture.selected;
  for (const spot of symbol === "rod" ? [from, to] : [at]) {
    put(symbol, classes, spot, isRound(symbol) ? 0 : angle, picture.before(spot[2], FRONT), { halo: view ? 1.5 : 0, selected });
  }
  paintLoads(picture, site, { place, from, to: end });
}

/** Whether a symbol looks the same however it is turned. */
function isRound(symbol) {
  return symbol === "pin" || symbol === "rod";
}

/** A circle that rolls, or of a wheel. */
function paintWheel(picture, wheel) {
  const { camera, poses, brush } = picture;
  const look = brush.looks.of("rails", "wheel");
  const { centre, across: [a, b] } = wheelAt(wheel, poses);
  if (!view) {
    const [x, y] = camera.project(centre);
    picture.add("rails", 0, () => {
      const path = new Path();
      path.arc(x, y, wheel.r * camera.scale, 0, 2 * Math.PI);
      brush.path(path, look);
    });
    return;
  }
  const parts = picture.isCrowd ? 16 : 48;
  const at = (k) => {
    const angle = (2 * Math.PI * k) / parts;
    return camera.project(plus(plus(centre, a, Math.cos(angle)), b, Math.sin(angle)));
  };
  const solid = { ...look, dash: [] };
  let last = at(0);
  for (let k = 1; k <= parts; k += 1) {
    const next = at(k);
    addThin(picture, "rails", last, next, solid, { width: 2.2, halo: 1.4 });
    last = next;
  }
  // A spoke tells how far it has turned.
  addThin(picture, "rails", camera.project(centre), at(0), solid, { width: 1.2, halo: 1 });
}

/** A guide, as long as its block travels: from there and back (m). */
function travelOf(site) {
  let [low, high] = [0, 0];
  for (let k = 0; k < frameCount; k += Math.max(frameCount >> 6, 1)) {
    const instant = instantAt(times[k]);
    const poses = posesAt(instant);
    const along = dot3(minus(site.end(poses, instant), site.place(poses, instant)), site.axis(poses, instant));
    [low, high] = [Math.min(low, along), Math.max(high, along)];
  }
  return [low, high];
}

function paintRail(picture, site, place, axis, from) {
  const { camera, brush } = picture;
  const look = brush.looks.of("rails", "rail");
  site.travel ??= travelOf(site);
  const { grounded } = site.joint.site;
  const [low, high] = site.travel;
  if (view) {
    const beyond = (RAIL * picture.symbolScale) / camera.scale;
    const ends = [low - beyond, high + beyond].map((x) => camera.project(plus(place, axis, x)));
    addThin(picture, "rails", ...ends, look, { width: 2, pixels: 3 });
    if (grounded) picture.add("feet", picture.before(from[2], 4), () => brush.symbol("foot", "", from, 0, picture.symbolScale));
    return;
  }
  const [start, stop] = [low * camera.scale - RAIL, high * camera.scale + RAIL];
  let d = `M${start} 0H${stop}`;
  if (grounded) {
    d += `M${start} 11H${stop}`;
    for (let x = start + 6; x <= stop; x += 8) d += `M${x} 11l-5 6`;
  }
  const [dx, dy] = camera.direction(axis);
  picture.add("rails", 0, () => brush.from(from, [dx, dy], d, look));
}

function paintForces(picture) {
  const { camera, poses, brush, symbolScale } = picture;
  for (const force of data.drawing.forces) {
    const points = force.points.map(([b, p]) => camera.project(pointOn(poses.of(b), spatial(p))));
    force.points.forEach(([b], k) => {
      if (b < 0) picture.add("feet", points[k][2], () => brush.symbol("foot", "", points[k], 0, symbolScale));
    });
    const [a, b] = points;
    if (points.length > 1) {
      const isLong = Math.hypot(b[0] - a[0], b[1] - a[1]) > 4;
      picture.add("springs", (a[2] + b[2]) / 2, () => {
        if (isLong) brush.path(springBetween(a, b), { ...brush.looks.of("spring"), fill: null }, { halo: view ? HALO : 0 });
        else brush.symbol("short spring", "", a, 0, 1);
      });
      continue;
    }
    const body = force.bodies.findLast((k) => k >= 0) ?? -1;
    const at = a ?? camera.project(poses.of(body).r);
    picture.add("springs", picture.before(at[2], FRONT), () => brush.symbol(a ? "load" : "couple", "", at, 0, symbolScale));
  }
}

function paintMarkers(picture) {
  const { camera, poses, brush } = picture;
  for (const { b, p } of data.drawing.markers) {
    const at = camera.project(pointOn(poses.of(b), spatial(p)));
    picture.add("markers", picture.before(at[2], FRONT), () => brush.symbol("marker", "", at));
  }
}

/** The points of a track along the run. */
function traceOf(index) {
  const parts = Math.max(1, Math.ceil(TRACE_POINTS / frameCount));
  const count = (frameCount - 1) * parts + 1;
  const between = (k) => {
    const [frame, part] = [Math.floor(k / parts), k % parts];
    return part ? times[frame] + (part / parts) * (times[frame + 1] - times[frame]) : times[frame];
  };
  const instants = Array.from({ length: count }, (_, k) => instantAt(between(k)));
  const { b, p } = tracks[index];
  return { index, instants, points: instants.map((instant) => pointOn(poseOf(b, instant), p)) };
}

function paintTraces(picture) {
  if (picture.firstOrder) return;
  const { camera, poses, brush, instant } = picture;
  for (const trace of picture.traces) {
    const colour = `c${trace.index % 7}`;
    const { b, p } = tracks[trace.index];
    const points = trace.points.map((point) => camera.project(point));
    const passed = trace.instants.findLastIndex((i) => i.t <= instant.t) + 1;
    const past = [...points.slice(0, passed), camera.project(pointOn(poses.of(b), p))];
    for (const [line, classes] of [[points, `trace whole ${colour}`], [past, `trace ${colour}`]]) {
      const look = brush.looks.of("traces", classes);
      const step = view ? 12 : line.length;
      for (let k = 0; k < line.length; k += step) {
        const part = line.slice(k, k + step + 1);
        const near = part.reduce((sum, at) => sum + at[2], 0) / part.length;
        picture.add("traces", near, () => {
          const path = new Path();
          part.forEach(([x, y]) => path.lineTo(x, y));
          brush.path(path, look, { halo: view && look.opacity === 1 ? 1.2 : 0 });
        });
      }
    }
  }
}

/** Lines at round numbers: in the plane through the picture, in space on a floor below everything, seen from above. */
function paintGrid(picture) {
  const { camera, brush } = picture;
  if (!picture.show.grid) return;
  const look = brush.looks.of("grid", "plain");
  const step = roundStep(64 / camera.scale);
  const path = new Path();
  if (!view) {
    const [w, h] = camera.page;
    const pitch = step * camera.scale;
    const [x0, y0] = camera.project([0, 0, 0]);
    for (let x = ((x0 % pitch) + pitch) % pitch; x < w; x += pitch) {
      path.moveTo(x, 0);
      path.lineTo(x, h);
    }
    for (let y = ((y0 % pitch) + pitch) % pitch; y < h; y += pitch) {
      path.moveTo(0, y);
      path.lineTo(w, y);
    }
    brush.path(path, look);
    return;
  }
  if (dot3(camera.towards, camera.above) < 0.04) return;
  const floor = camera.above.map((x) => x * picture.lowest);
  const level = Object.values(AXES).map((a) => unit(minus(a, camera.above.map((x) => x * dot3(a, camera.above)))));
  const first = level.find((a) => norm(a) > 0.5);
  const sides = [first, cross(camera.above, first)];
  const half = Math.max(3, Math.ceil((0.75 * camera.reach) / step));
  const [u, v] = sides.map((side) => Math.round(dot3(camera.focus, side) / step));
  const at = (i, j) => camera.project(plus(plus(floor, sides[0], (u + i) * step), sides[1], (v + j) * step));
  for (let k = -Math.min(half, 40); k <= Math.min(half, 40); k += 1) {
    for (const [a, b] of [[at(k, -half), at(k, half)], [at(-half, k), at(half, k)]]) {
      path.moveTo(a[0], a[1]);
      path.lineTo(b[0], b[1]);
    }
  }
  brush.path(path, look);
}

/** A bar that tells the distance of the lines of the grid; in space the axes of the ground, each of a round length. */
function paintScale(picture) {
  const { camera, brush } = picture;
  const [, h] = camera.page;
  const look = brush.looks.of("scale", "plain");
  const text = brush.looks.of("scale", "text plain");
  if (!view) {
    const step = roundStep(64 / camera.scale);
    const pitch = step * camera.scale;
    brush.path(new Path(`M18 ${h - 22}v8h${pitch.toFixed(1)}v-8`), look);
    brush.text(lengthInWords(step), 18 + pitch / 2, h - 20, text, "center");
    return;
  }
  const step = roundStep(20 / camera.scale);
  const [x0, y0] = [52, h - 62];
  const arms = Object.entries(AXES).map(([name, axis]) => ({ name, near: dot3(axis, camera.towards), to: camera.direction(axis) }));
  arms.sort((a, b) => a.near - b.near);
  for (const { name, to: [dx, dy] } of arms) {
    const arm = step * camera.scale;
    brush.line([x0, y0], [x0 + arm * dx, y0 + arm * dy], look, { halo: 1.5 });
    const seen = Math.hypot(dx, dy);
    const beyond = seen > 0.2 ? arm + 11 / seen : 0;
    const side = seen > 0.2 ? 0 : 10;
    brush.text(name, x0 + beyond * dx - side, y0 + beyond * dy + 4 + side, text, "center");
  }
  brush.text(`axes ${lengthInWords(step)}`, 18, h - 12, text);
}

function lengthInWords(x) {
  const [size, name] = [[1e3, "km"], [1, "m"], [1e-3, "mm"], [1e-6, "µm"]].find(([u]) => x >= 0.999 * u) ?? [1, "m"];
  const [unitSize, unitName] = x >= 0.0999 && x < 1 ? [1, "m"] : [size, name];
  return `${spoken(x / unitSize)} ${unitName}`;
}
