// The data of the page: curves from their differences, and what lies between frames.

/** The document that stands in the page. */
const data = JSON.parse(document.getElementById("data").textContent);

/** Times of the frames (s). */
const times = Float64Array.from(data.t);
const frameCount = times.length;
const tFirst = frameCount ? times[0] : 0;
const tLast = frameCount ? times[frameCount - 1] : 0;

/**
 * The values of a channel at the frames. A number stands for a constant, `null` for a curve that is not there.
 * @returns {Float64Array}
 */
function decode(channel) {
  if (channel === null || typeof channel === "number") {
    return new Float64Array(frameCount).fill(channel ?? NaN);
  }
  const out = new Float64Array(frameCount).fill(NaN);
  let level = 0;
  channel.d.forEach((step, k) => {
    if (step === null) return;
    level += step;
    out[k] = channel.o + channel.s * level;
  });
  return out;
}

/**
 * Where a time lies: after frame `k`, by the share `s` of the `h` seconds to the next one.
 * @returns {{k: number, s: number, h: number, t: number}}
 */
function instantAt(t) {
  let low = 0;
  let high = Math.max(frameCount - 2, 0);
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  const h = frameCount > 1 ? times[low + 1] - times[low] : 0;
  const s = h > 0 ? Math.min(Math.max((t - times[low]) / h, 0), 1) : 0;
  return { k: low, s, h, t };
}

/** The frame nearest to an instant. */
function nearestFrame({ k, s }) {
  return Math.min(s > 0.5 ? k + 1 : k, frameCount - 1);
}

/** A straight line between frames. */
function linear(values, { k, s }) {
  return s > 0 ? values[k] + s * (values[k + 1] - values[k]) : values[k];
}

/** A cubic between frames, with the rates at both. */
function cubic(values, rates, instant) {
  const { k, s, h } = instant;
  if (!(s > 0)) return values[k];
  const r = 1 - s;
  return (1 + 2 * s) * r * r * values[k] + s * r * r * h * rates[k]
    + s * s * (3 - 2 * s) * values[k + 1] - s * s * r * h * rates[k + 1];
}

/** How space is seen: the directions to the right and upwards in the picture; `null` in the plane, which is the picture. */
const view = data.drawing.view ?? null;
const CURVES = view
  ? ["x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]
  : ["x", "y", "angle", "vx", "vy", "omega"];

/** Bodies with decoded curves. */
const bodies = data.drawing.bodies.map((body, index) => ({
  index,
  name: body.name,
  outline: body.outline,
  ...Object.fromEntries(CURVES.map((name) => [name, decode(body[name])])),
}));

/** Rows of the rotation matrix of a quaternion of any length. */
function rotation([w, x, y, z]) {
  const s = 2 / (w * w + x * x + y * y + z * z);
  return [
    [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
    [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
    [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
  ];
}

const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);

/** Where a point of the ground is in the picture. */
function flat(point) {
  return view ? view.map((row) => dot(row, point)) : point;
}

/** The curves of a point of a body: its place and velocity, and the rotation of the body. */
function carried(body, p, a) {
  const arms = Array.from({ length: frameCount }, (_, k) => {
    if (view) return rotation([body.qw[k], body.qx[k], body.qy[k], body.qz[k]]).map((row) => dot(row, p));
    const [c, s] = [Math.cos(body.angle[k]), Math.sin(body.angle[k])];
    return [c * p[0] - s * p[1], s * p[0] + c * p[1]];
  });
  const plus = (values, of) => values.map((v, k) => v + of(k, arms[k]));
  const curves = { x: plus(body.x, (_, arm) => arm[0]), y: plus(body.y, (_, arm) => arm[1]) };
  if (!view) {
    const { omega } = body;
    return {
      ...curves,
      angle: body.angle.map((v) => v + a),
      vx: plus(body.vx, (k, arm) => -omega[k] * arm[1]),
      vy: plus(body.vy, (k, arm) => omega[k] * arm[0]),
    };
  }
  const { wx, wy, wz } = body;
  return {
    ...curves,
    z: plus(body.z, (_, arm) => arm[2]),
    vx: plus(body.vx, (k, arm) => wy[k] * arm[2] - wz[k] * arm[1]),
    vy: plus(body.vy, (k, arm) => wz[k] * arm[0] - wx[k] * arm[2]),
    vz: plus(body.vz, (k, arm) => wx[k] * arm[1] - wy[k] * arm[0]),
  };
}

/**
 * What is traced and plotted: the origins of the frames of bodies, then markers that can move. `b` is the body, `p` the place relative to its
 * centre of mass.
 */
const tracks = [
  ...bodies.map((body) => ({ name: body.name, b: body.index, p: data.drawing.bodies[body.index].frame ?? (view ? [0, 0, 0] : [0, 0]), a: 0 })),
  ...data.drawing.markers.filter((marker) => marker.b >= 0),
].map(({ name, b, p, a }, index) => {
  const own = Object.fromEntries(CURVES.map((curve) => [curve, bodies[b][curve]]));
  return { index, name, b, p, ...own, ...(p.some((x) => x) || a ? carried(own, p, a) : {}) };
});

/** Pose of a body in the picture at an instant: its centre, and what its axes look like there. Body −1 is the ground. */
function poseOf(index, instant) {
  if (view) return spatialPose(index, instant);
  if (index < 0) return { x: 0, y: 0, angle: 0, rows: [[1, 0], [0, 1]] };
  const b = bodies[index];
  const angle = cubic(b.angle, b.omega, instant);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return {
    x: cubic(b.x, b.vx, instant),
    y: cubic(b.y, b.vy, instant),
    angle,
    rows: [[c, -s], [s, c]],
  };
}

function spatialPose(index, instant) {
  if (index < 0) return { x: 0, y: 0, angle: 0, rows: view };
  const b = bodies[index];
  const [x, y] = flat(["x", "y", "z"].map((axis) => cubic(b[axis], b[`v${axis}`], instant)));
  const turned = rotation(quaternionAt(b, instant));
  const rows = view.map((row) => [0, 1, 2].map((k) => dot(row, turned.map((r) => r[k]))));
  return { x, y, angle: 0, rows };
}

/** The orientation of a body between frames: ė = ½·(0, ω)∘e, with ω in ground axes. */
function quaternionAt({ qw, qx, qy, qz, wx, wy, wz }, { k, s, h, t }) {
  const ends = s > 0 ? [k, k + 1] : [k];
  const e = ends.map((f) => [qw[f], qx[f], qy[f], qz[f]]);
  if (!(s > 0)) return e[0];
  const rates = ends.map((f, end) => {
    const [w, x, y, z] = e[end];
    const [a, b, c] = [wx[f], wy[f], wz[f]];
    return [-a * x - b * y - c * z, a * w + b * z - c * y, b * w + c * x - a * z, c * w + a * y - b * x].map((rate) => rate / 2);
  });
  return [0, 1, 2, 3].map((part) => cubic(e.map((x) => x[part]), rates.map((x) => x[part]), { k: 0, s, h, t }));
}

/** A point of a body in the picture. */
function pointOn(pose, p) {
  return [pose.x + dot(p, pose.rows[0]), pose.y + dot(p, pose.rows[1])];
}

/** A function that tells where a place is, given the poses of all bodies. */
function placeFinder(place) {
  if ("b" in place) return (poses, _) => pointOn(poses.of(place.b), place.p);
  const curves = (view ? ["x", "y", "z"] : ["x", "y"]).map((name) => decode(place[name]));
  return (_, instant) => flat(curves.map((curve) => linear(curve, instant)));
}

/** A function that tells what an axis in space looks like: shorter than one where it is seen from the side. */
function axisFinder(axis) {
  if (!view || !axis) return null;
  if ("b" in axis) return (poses, _) => poses.of(axis.b).rows.map((row) => dot(row, axis.p));
  return placeFinder(axis);
}

/** A function that tells the angle of an axis. */
function headingFinder(axis) {
  if (!axis) return () => 0;
  if (view) {
    const find = axisFinder(axis);
    return (poses, instant) => {
      const [x, y] = find(poses, instant);
      return Math.atan2(y, x);
    };
  }
  if ("b" in axis) return (poses, _) => poses.of(axis.b).angle + axis.a;
  const a = decode(axis.a);
  return (_, instant) => linear(a, instant);
}

/** Poses of all bodies at an instant, each computed once. */
function posesAt(instant) {
  const known = new Map();
  return {
    of(index) {
      if (!known.has(index)) known.set(index, poseOf(index, instant));
      return known.get(index);
    },
  };
}

/** Names of the components of a reaction; those of the force come first. */
const COMPONENTS = data.components.map(([name]) => name);
const FORCES = data.components.filter(([, unit]) => unit === "N").length;

/** Joints and drives with decoded reactions, and what choices say of them. */
const joints = data.joints.map((joint, index) => ({
  ...joint,
  index,
  site: data.drawing.sites[index],
  wrench: joint.reaction?.wrench.map(decode) ?? null,
  named: joint.reaction?.named !== undefined ? decode(joint.reaction.named) : null,
  choices: [],
  freedom: null,
}));

for (const comparison of data.comparisons) {
  comparison.joints.forEach((k, place) => {
    const freedom = comparison.freedom[place];
    joints[k].freedom = { ...freedom, angle: decode(freedom.angle) };
    joints[k].choices = comparison.choices.map((choice) => ({
      label: choice.label,
      wrench: choice.wrenches[place].map(decode),
    }));
  });
}

/**
 * The verdict of a component along the run. Where choices were compared they tell; the verdicts of the analysis are those of the start, and
 * a component in global directions may be determined there only.
 */
function verdictOf(joint, name, inBody = false) {
  const place = COMPONENTS.indexOf(name);
  if (joint.freedom) return joint.freedom[inBody ? "in_body" : "components"][place] ? "not_unique" : "unique";
  return joint.verdict === "unique" ? "unique" : joint.verdict;
}

/** Smallest and largest finite values of several curves; nothing if there are none. */
function rangeOf(curves) {
  let [low, high] = [Infinity, -Infinity];
  for (const curve of curves) {
    for (const x of curve) {
      if (x < low) low = x;
      if (x > high) high = x;
    }
  }
  return low <= high ? [low, high] : null;
}

/** A number with so many digits, as people write it. */
function spoken(x, digits = 4) {
  if (!Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const size = Math.abs(x);
  const text = size >= 1e5 || size < 1e-3
    ? x.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e")
    : String(Number(x.toPrecision(digits)));
  return text.replaceAll("-", "−");
}

/** The smallest round number that is not below another. */
function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return Number((power * [1, 2, 5, 10].find((f) => f * power >= least * 0.999)).toPrecision(3));
}

/** Round numbers that divide a range into about `count` parts. */
function ticksOf([low, high], count) {
  const raw = (high - low) / Math.max(count, 1);
  if (!(raw > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 2.5, 5, 10].find((f) => f * power >= raw * 0.999);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
    ticks.push(Number((k * step).toPrecision(12)));
  }
  return ticks;
}

/** Nodes of a text in which names stand between grave accents. */
function withNames(text) {
  return text.split("`").map((part, k) => (k % 2 ? make(null, "b", { textContent: part }) : part));
}

const SVG = "http://www.w3.org/2000/svg";

/** A new SVG element with attributes, put into a parent. */
function draw(parent, tag, attributes = {}, text = null) {
  const element = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== null) element.textContent = text;
  parent?.append(element);
  return element;
}

/** A new HTML element with properties, put into a parent. */
function make(parent, tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  parent?.append(element);
  return element;
}
