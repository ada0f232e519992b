// Poses between frames, and places, directions and tracks that follow from them. All vectors have three components: the plane is z = 0.

/** How space is seen at first: `right`, `up` in the picture, and what is upright, `above`; `null` in the plane, which is seen along z. */
const view = data.drawing.view ?? null;
const CURVES = view
  ? ["x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]
  : ["x", "y", "angle", "vx", "vy", "omega"];

const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const plus = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const minus = (a, b) => plus(a, b, -1);
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => {
  const size = norm(a);
  return size > 0 ? a.map((x) => x / size) : [0, 0, 0];
};
/** A point of the data with three components. */
const spatial = (p) => (p.length > 2 ? p : [p[0], p[1], 0]);

/** Rows of the rotation matrix of a quaternion of any length. */
function rotation([w, x, y, z]) {
  const s = 2 / (w * w + x * x + y * y + z * z);
  return [
    [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
    [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
    [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
  ];
}

/** Rows of the matrix that turns about the upright of the plane. */
function turnInPlane(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [[c, -s, 0], [s, c, 0], [0, 0, 1]];
}

const UNTURNED = turnInPlane(0);

/** A vector of a body in ground axes. */
const turnedBy = (rows, p) => [dot3(rows[0], p), dot3(rows[1], p), dot3(rows[2], p)];

/** Bodies; their curves are decoded when somebody asks. */
const bodies = data.drawing.bodies.map((body, index) => {
  const own = {
    index,
    name: body.name,
    /** Takes other data of the same body. */
    renew(fresh) {
      Object.assign(own, { outline: fresh.outline.map(spatial), origin: spatial(fresh.frame ?? [0, 0, 0]) });
      for (const name of CURVES) defineLazily(own, name, () => decode(fresh[name]));
    },
  };
  own.renew(body);
  return own;
});

/** Curves of a point of a body, as arms from its centre of mass. */
function carried(body, p, a) {
  const own = {};
  const of = (name, arm) => defineLazily(own, name, () => {
    const arms = armsOf();
    return body[name].map((value, k) => value + arm(k, arms[k]));
  });
  let arms = null;
  const armsOf = () => {
    const turn = (k) => (view ? rotation([body.qw[k], body.qx[k], body.qy[k], body.qz[k]]) : turnInPlane(body.angle[k]));
    arms ??= Array.from(times, (_, k) => turnedBy(turn(k), p));
    return arms;
  };
  of("x", (_, arm) => arm[0]);
  of("y", (_, arm) => arm[1]);
  if (!view) {
    of("angle", () => a);
    of("vx", (k, arm) => -body.omega[k] * arm[1]);
    of("vy", (k, arm) => body.omega[k] * arm[0]);
    return own;
  }
  of("z", (_, arm) => arm[2]);
  of("vx", (k, arm) => body.wy[k] * arm[2] - body.wz[k] * arm[1]);
  of("vy", (k, arm) => body.wz[k] * arm[0] - body.wx[k] * arm[2]);
  of("vz", (k, arm) => body.wx[k] * arm[1] - body.wy[k] * arm[0]);
  return own;
}

/**
 * What is traced and plotted: the origins of the frames of bodies, then markers that can move. `b` is the body, `p` the place relative to its
 * centre of mass.
 */
const tracks = [
  ...bodies.map((body) => ({ name: body.name, b: body.index, p: body.origin, a: 0 })),
  ...data.drawing.markers.filter((marker) => marker.b >= 0).map((marker) => ({ ...marker, p: spatial(marker.p) })),
].map(({ name, b, p, a }, index) => {
  const track = { index, name, b, p };
  const moved = p.some((x) => x) || a ? carried(bodies[b], p, a) : {};
  for (const curve of CURVES) defineLazily(track, curve, () => moved[curve] ?? bodies[b][curve]);
  return track;
});

const GROUND_POSE = { r: [0, 0, 0], rows: UNTURNED };

/** Pose of a body at an instant: its centre `r` and the rows of its rotation. Body −1 is the ground. */
function poseOf(index, instant) {
  if (index < 0) return GROUND_POSE;
  const b = bodies[index];
  if (!view) {
    return {
      r: [cubic(b.x, b.vx, instant), cubic(b.y, b.vy, instant), 0],
      rows: turnInPlane(cubic(b.angle, b.omega, instant)),
    };
  }
  return {
    r: [cubic(b.x, b.vx, instant), cubic(b.y, b.vy, instant), cubic(b.z, b.vz, instant)],
    rows: rotation(quaternionAt(b, instant)),
  };
}

/** The orientation of a body between frames: ė = ½·(0, ω)∘e, with ω in ground axes. */
function quaternionAt({ qw, qx, qy, qz, wx, wy, wz }, { k, s, h }) {
  if (!(s > 0)) return [qw[k], qx[k], qy[k], qz[k]];
  const r = 1 - s;
  const e = [0, 0, 0, 0];
  for (let end = 0; end < 2; end += 1) {
    const f = k + end;
    const [w, x, y, z, a, b, c] = [qw[f], qx[f], qy[f], qz[f], wx[f], wy[f], wz[f]];
    const value = end ? s * s * (3 - 2 * s) : (1 + 2 * s) * r * r;
    const rate = (h / 2) * (end ? -s * s * r : s * r * r);
    e[0] += value * w + rate * (-a * x - b * y - c * z);
    e[1] += value * x + rate * (a * w + b * z - c * y);
    e[2] += value * y + rate * (b * w + c * x - a * z);
    e[3] += value * z + rate * (c * w + a * y - b * x);
  }
  return e;
}

/** A point of a body. */
function pointOn(pose, p) {
  return plus(pose.r, turnedBy(pose.rows, p));
}

/** Poses of all bodies at an instant, each computed once, changed by `swing` if there is one. */
function posesAt(instant, swing = null) {
  const known = new Array(bodies.length);
  return {
    of(index) {
      if (index < 0) return GROUND_POSE;
      known[index] ??= swing ? swing(index, poseOf(index, instant)) : poseOf(index, instant);
      return known[index];
    },
  };
}

/** A function that tells where a place is, given the poses of all bodies. */
function placeFinder(place) {
  if ("b" in place) {
    const p = spatial(place.p);
    return (poses, _) => pointOn(poses.of(place.b), p);
  }
  const curves = (view ? ["x", "y", "z"] : ["x", "y"]).map((name) => decode(place[name]));
  return (_, instant) => spatial(curves.map((curve) => linear(curve, instant)));
}

/** A function that tells the direction of an axis in ground axes; without an axis it is `null`. */
function axisFinder(axis) {
  if (!axis) return null;
  if ("p" in axis) return (poses, _) => turnedBy(poses.of(axis.b).rows, spatial(axis.p));
  if (!("a" in axis)) return placeFinder(axis);
  const along = (angle) => [Math.cos(angle), Math.sin(angle), 0];
  if ("b" in axis) return (poses, _) => turnedBy(poses.of(axis.b).rows, along(axis.a));
  const a = decode(axis.a);
  return (_, instant) => along(linear(a, instant));
}
