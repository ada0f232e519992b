// The body of which only points are known: their convex hull in space, as corners, edges and faces.

/** More points than this would take long; then only the outermost in many directions are looked at. */
const CORNERS_MOST = 24;
const FLAT = 1e-7;

/**
 * The convex hull of points: `edges` as pairs of points with the faces at their sides, `faces` as rings of points with their normals outwards.
 * Points of a plane have one face with both sides, points of a line one edge, a single point neither.
 */
function solidOf(all) {
  const points = outermost(distinct(all));
  const size = Math.max(...points.map((p) => norm(minus(p, points[0]))));
  const near = (x, power) => Math.abs(x) <= FLAT * size ** power;
  const none = { points, edges: [], faces: [] };
  if (points.length < 2) return none;
  const far = farthest(points, (p) => norm(minus(p, points[0])));
  const along = unit(minus(points[far], points[0]));
  const off = (p) => norm(cross(along, minus(p, points[0])));
  const third = farthest(points, off);
  if (near(off(points[third]), 1)) {
    const place = (p) => dot3(p, along);
    return { ...none, edges: [{ ends: [farthest(points, (p) => -place(p)), farthest(points, place)], faces: [] }] };
  }
  const across = unit(cross(along, minus(points[third], points[0])));
  if (points.every((p) => near(dot3(across, minus(p, points[0])), 1))) {
    const ring = ringOf(points, points.map((_, k) => k), across);
    return { ...none, edges: edgesOf([ring]), faces: [{ ring, normal: across, isSheet: true }] };
  }
  const faces = facesOf(points, size);
  return { ...none, edges: edgesOf(faces.map((f) => f.ring)), faces };
}

function distinct(all) {
  const size = Math.max(...all.map((p) => norm(minus(p, all[0]))), 1e-12);
  return all.filter((p, k) => all.slice(0, k).every((other) => norm(minus(p, other)) > FLAT * size));
}

function farthest(points, of) {
  const sizes = points.map(of);
  return sizes.indexOf(Math.max(...sizes));
}

function outermost(points) {
  if (points.length <= CORNERS_MOST) return points;
  const chosen = new Set();
  for (let k = 0; k < 2 * CORNERS_MOST; k += 1) {
    // Points of a spiral on the sphere.
    const z = 1 - (2 * k + 1) / (2 * CORNERS_MOST);
    const r = Math.sqrt(1 - z * z);
    const d = [r * Math.cos(2.4 * k), r * Math.sin(2.4 * k), z];
    chosen.add(farthest(points, (p) => dot3(p, d)));
  }
  return [...chosen].map((k) => points[k]);
}

/** Planes through three points with all others on one side. */
function facesOf(points, size) {
  const faces = [];
  for (let i = 0; i < points.length; i += 1) {
    for (let j = i + 1; j < points.length; j += 1) {
      for (let k = j + 1; k < points.length; k += 1) {
        const turn = cross(minus(points[j], points[i]), minus(points[k], points[i]));
        if (norm(turn) <= FLAT * size * size) continue;
        let normal = unit(turn);
        const heights = points.map((p) => dot3(normal, minus(p, points[i])));
        const [low, high] = [Math.min(...heights), Math.max(...heights)];
        if (low < -FLAT * size && high > FLAT * size) continue;
        if (high > FLAT * size) normal = normal.map((x) => -x);
        if (faces.some((f) => dot3(f.normal, normal) > 1 - 1e-9)) continue;
        const on = heights.flatMap((h, n) => (Math.abs(h) <= FLAT * size ? [n] : []));
        faces.push({ ring: ringOf(points, on, normal), normal, isSheet: false });
      }
    }
  }
  return faces;
}

/** The corners of the convex polygon of points of a plane, in order. */
function ringOf(points, on, normal) {
  const middle = on.reduce((sum, k) => plus(sum, points[k], 1 / on.length), [0, 0, 0]);
  const first = unit(minus(points[on[farthest(on.map((k) => points[k]), (p) => norm(minus(p, middle)))]], middle));
  const second = cross(normal, first);
  const reach = Math.max(...on.map((k) => norm(minus(points[k], middle))));
  const flat = on.map((k) => {
    const d = minus(points[k], middle).map((x) => x / reach);
    return Object.assign([dot3(d, first), dot3(d, second)], { k });
  });
  return hull(flat).map((p) => p.k);
}

function edgesOf(rings) {
  const edges = new Map();
  rings.forEach((ring, face) => ring.forEach((a, n) => {
    const b = ring[(n + 1) % ring.length];
    const key = `${Math.min(a, b)} ${Math.max(a, b)}`;
    if (!edges.has(key)) edges.set(key, { ends: [a, b], faces: [] });
    edges.get(key).faces.push(face);
  }));
  return [...edges.values()];
}
