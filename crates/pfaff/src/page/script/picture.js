// The mechanism to scale, moved along the run. Symbols keep their size in pixels; bodies, grid and traces are to scale. The plane is painted
// layer by layer, space from the back to the front.

const MOVED_FAR = 2.2;
const SMALLEST = 2e-3;
/** Names of a larger mechanism are shown when somebody asks. */
const NAMES_MOST = 60;
/** Bodies and joints that are many. */
const CROWD = 400;
/** Points and instants that are looked at to find what a run needs of the page. */
const PROBES = 48;
const POINTS_MOST = 60_000;
/** What is painted over what in the plane. */
const LAYERS = ["traces", "bodies", "rails", "feet", "springs", "symbols", "markers", "freedom", "arrows"];
const LAYER = Object.fromEntries(LAYERS.map((name, k) => [name, k]));

class Picture {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas, handlers) {
    this.canvas = canvas;
    // Among many, symbols are stamped and lines are plain, and arrows are shown when somebody asks.
    this.isCrowd = bodies.length + joints.length > CROWD;
    this.show = {
      names: joints.length + bodies.length + data.drawing.markers.length <= NAMES_MOST,
      forces: !this.isCrowd, freedom: !this.isCrowd, grid: true, centres: !this.isCrowd, follow: true,
    };
    this.arrowScale = 1;
    this.traced = new Set();
    this.traces = [];
    this.selected = -1;
    this.firstOrder = null;
    this.t = tFirst;
    this.camera = new Camera();
    this.brush = new Brush(canvas);
    this.drag = null;
    this.build();
    this.measure();
    this.large = this.largeLoads();
    listen(this, handlers);
    addEventListener("themechange", () => this.recolour());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.recolour());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** Prepares what the data of the drawing state. */
  build() {
    this.sites = joints.map((joint) => ({
      joint,
      place: placeFinder(joint.site.place),
      end: joint.site.end ? placeFinder(joint.site.end) : null,
      axis: axisFinder(joint.site.axis),
      isGuided: ["block", "slot"].includes(joint.site.symbol),
      wheels: joint.site.wheels.map(wheelOf),
    }));
    if (view) bodies.forEach((body) => defineLazily(body, "solid", () => solidOf(body.outline)));
    this.names = new Names(this);
  }

  /** Shows another start of the same bodies and joints. The view stays during a drag. */
  startFrom(fresh) {
    data.drawing = fresh.drawing;
    fresh.drawing.bodies.forEach((body, k) => bodies[k].renew(body));
    fresh.joints.forEach((joint, k) => Object.assign(joints[k], joint, { site: fresh.drawing.sites[k] }));
    const offsets = this.names.all.map(({ offset }) => offset);
    this.build();
    this.names.all.forEach((name, k) => Object.assign(name, { offset: offsets[k] ?? name.offset }));
    if (!this.drag) {
      this.measure();
      this.fit();
    }
    this.paint();
    if (this.drag) this.drag.announce();
    else this.names.later();
  }

  /** All points at an instant. */
  pointsAt(instant, poses = posesAt(instant)) {
    const points = [];
    for (const body of bodies) {
      const pose = poses.of(body.index);
      points.push(pose.r);
      body.outline.forEach((p) => points.push(pointOn(pose, p)));
    }
    for (const site of this.sites) {
      points.push(site.place(poses, instant));
      for (const wheel of site.wheels) {
        const { centre, across } = wheelAt(wheel, poses);
        across.forEach((a) => points.push(plus(centre, a), minus(centre, a)));
        if (!view) across.forEach((a, k) => points.push(plus(plus(centre, a), across[1 - k]), minus(minus(centre, a), across[1 - k])));
      }
    }
    for (const { b, p } of data.drawing.markers) points.push(pointOn(poses.of(b), spatial(p)));
    for (const { points: held } of data.drawing.forces) held.forEach(([b, p]) => points.push(pointOn(poses.of(b), spatial(p))));
    return points;
  }

  /** Extents of the mechanism at one instant, and of the whole run, along the axes of the ground. */
  measure() {
    const first = this.pointsAt(instantAt(tFirst));
    const count = Math.max(Math.min(frameCount, PROBES, Math.floor(POINTS_MOST / first.length)), 1);
    this.probes = Array.from({ length: count }, (_, p) => {
      const k = Math.round((p * (frameCount - 1)) / Math.max(count - 1, 1));
      return this.pointsAt(instantAt(times[k])).filter((point) => point.every(Number.isFinite));
    });
    const { size, whole } = this.extents((p) => p);
    this.middle = whole.map(([a, b]) => (a + b) / 2);
    this.lowest = Math.min(...this.probes.map((points) => points.reduce((low, p) => Math.min(low, dot3(p, this.camera.above)), Infinity)));
    const span = whole.map(([a, b]) => b - a);
    const far = norm(span) > MOVED_FAR * norm(size);
    const grounded = data.drawing.sites.some((s) => s.grounded);
    this.travels = far && norm(size) > SMALLEST * norm(span) && !grounded;
  }

  /** Largest extents at one instant and extents of the whole run, of points as `of` sees them. */
  extents(of) {
    const empty = () => [[Infinity, -Infinity], [Infinity, -Infinity], [Infinity, -Infinity]];
    const whole = empty();
    const size = [1e-9, 1e-9, 1e-9];
    for (const points of this.probes) {
      const box = boxOf(points.map(of), empty());
      for (const axis of [0, 1, 2]) {
        size[axis] = Math.max(size[axis], box[axis][1] - box[axis][0]);
        whole[axis] = [Math.min(whole[axis][0], box[axis][0]), Math.max(whole[axis][1], box[axis][1])];
      }
    }
    if (!whole.flat().every(Number.isFinite)) return { size: [1, 1, 1], whole: [[0, 1], [0, 1], [0, 1]] };
    if (Math.max(...whole.map(([a, b]) => b - a)) >= 1e-9) return { size, whole };
    return { size, whole: whole.map(([a, b], axis) => (view || axis < 2 ? [(a + b) / 2 - 0.5, (a + b) / 2 + 0.5] : [0, 0])) };
  }

  /** Large force and torque among all reactions of the run; few are larger. */
  largeLoads() {
    const [forces, torques] = [[], []];
    const stride = Math.max(frameCount >> 7, 1) * Math.ceil(joints.length / 400);
    for (const { wrench } of joints) {
      if (!wrench) continue;
      for (let k = 0; k < frameCount; k += stride) {
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

  get follows() {
    return this.travels && this.show.follow;
  }

  /** Page and scale from the size of the window and what is to be seen. */
  resize(fit = true) {
    const { camera } = this;
    camera.page = [Math.max(this.canvas.clientWidth, 200), Math.max(this.canvas.clientHeight, 200)];
    if (fit) this.fit();
    this.names.place();
    this.paint();
  }

  /** Paints for a page of paper of this size (px), finer than for the screen; `resize` goes back. */
  printTo(width, height, ratio) {
    const { camera } = this;
    this.brush.looks.refresh();
    camera.page = [width, height];
    this.fit();
    this.names.place();
    this.paint(ratio);
  }

  /** The largest scale at which all is seen from where the camera stands. */
  fit() {
    const { camera } = this;
    const { size, whole } = this.extents((p) => [dot3(p, camera.right), dot3(p, camera.up), dot3(p, camera.towards)]);
    const span = this.follows ? size.map((x) => 1.04 * x) : whole.map(([a, b]) => b - a);
    const room = [camera.page[0] - 130, camera.page[1] - 110];
    camera.base = Math.min(room[0] / Math.max(span[0], 1e-12), room[1] / Math.max(span[1], 1e-12));
    camera.reach = norm(span) / 2;
    this.symbolScale = this.roomForSymbols();
  }

  /** Symbols shrink where half of them stand closer together than they are large. */
  roomForSymbols() {
    const instant = instantAt(tFirst);
    const poses = posesAt(instant);
    const { camera } = this;
    camera.aim(this.focusAt(instant));
    const places = this.sites.map((site) => camera.project(site.place(poses, instant)));
    const some = places.filter((_, k) => k % Math.ceil(places.length / 200) === 0);
    const nearest = some.map(([x, y]) => {
      let least = Infinity;
      for (const [u, v] of places) {
        const far = Math.hypot(u - x, v - y);
        if (far > 1e-6 * camera.page[0] && far < least) least = far;
      }
      return least;
    }).filter(Number.isFinite).sort((a, b) => a - b);
    const typical = nearest[nearest.length >> 1] ?? Infinity;
    return Math.min(Math.max(typical / 30, 0.2), 1);
  }

  /** The point of space in the middle of the page. */
  focusAt(instant, poses = posesAt(instant)) {
    if (!this.follows) return this.middle;
    const empty = [[Infinity, -Infinity], [Infinity, -Infinity], [Infinity, -Infinity]];
    const points = this.isCrowd ? bodies.map((_, k) => poses.of(k).r) : this.pointsAt(instant, poses);
    return boxOf(points, empty).map(([a, b]) => (a + b) / 2);
  }

  /** Shows an instant. */
  moveTo(t) {
    this.t = t;
    this.paint();
  }

  /** Paints before the next frame, once for all that asks for it. */
  soon() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.paint();
    });
  }

  /** Colours have changed. */
  recolour() {
    this.brush.looks.refresh();
    this.paint();
  }

  /** All that is painted, for `ratio` pixels of the screen for one of the page. */
  paint(ratio = globalThis.devicePixelRatio || 1) {
    const { camera, brush } = this;
    this.instant = instantAt(this.firstOrder ? tFirst : this.t);
    this.poses = posesAt(this.instant, this.firstOrder?.swing ?? null);
    camera.aim(this.focusAt(this.instant, this.poses));
    brush.clear(...camera.page, ratio, brush.looks.page);
    this.items = [];
    this.targets = [];
    paintGrid(this);
    paintTraces(this);
    paintBodies(this);
    this.sites.forEach((site) => paintSite(this, site));
    paintForces(this);
    paintMarkers(this);
    // Sorting keeps the order of equals, so that layers are painted as they come.
    this.items.sort((a, b) => a.key - b.key);
    this.items.forEach((item) => item.paint());
    paintScale(this);
    if (this.show.names) this.names.paint();
    this.painted = (this.painted ?? 0) + 1;
  }

  /** Paints the picture as it is seen now with another brush, without the mark of the body under the pointer. */
  paintWith(other, ratio) {
    const { brush, hovered } = this;
    Object.assign(this, { brush: other, hovered: undefined });
    try {
      this.paint(ratio);
    } finally {
      Object.assign(this, { brush, hovered });
    }
  }

  /** Something to be painted: in the plane in its layer, in space at its distance (m, towards the eye). */
  add(layer, near, paint) {
    this.items.push({ key: view ? near : LAYER[layer], paint });
  }

  /** How near something is that stands so many pixels in front of a place. */
  before(near, pixels) {
    return near + pixels / this.camera.scale;
  }

  /** Shows or hides the path of a track. */
  trace(index, wanted) {
    if (wanted) this.traced.add(index);
    else this.traced.delete(index);
    this.traces = [...this.traced].map((k) => this.traces.find((t) => t.index === k) ?? traceOf(k));
    this.soon();
  }

  /** Marks the joint whose reaction is shown. */
  select(index) {
    this.selected = index;
    this.soon();
  }

  /** Shows free motions or a self-stress at the start instead of the run; `null` goes back to it. */
  showFirstOrder(firstOrder) {
    this.firstOrder = firstOrder;
    this.paint();
    this.names.place();
    this.soon();
  }

  /** Zooms about the middle, or a place of the page; 0 goes back to the beginning. */
  zoomBy(factor, about = this.camera.page.map((x) => x / 2)) {
    const { camera } = this;
    if (factor === 0) {
      Object.assign(camera, { zoom: 1, shift: [0, 0] });
      camera.home();
      this.resize();
      this.tellView?.();
      return;
    }
    const before = camera.zoom;
    camera.zoom = Math.min(Math.max(camera.zoom * factor, 0.1), 200);
    const by = camera.zoom / before;
    camera.shift = camera.shift.map((x, k) => by * x + (1 - by) * (about[k] - camera.page[k] / 2));
    this.names.later();
    this.soon();
  }

  panBy(dx, dy) {
    const { camera } = this;
    camera.shift = [camera.shift[0] + dx, camera.shift[1] + dy];
    this.soon();
  }

  orbitBy(turn, raise) {
    this.camera.orbit(turn, raise);
    this.tellView?.();
    this.names.later();
    this.soon();
  }

  /** Looks along an axis of the ground, or from the first place, and shows all. */
  stand(name) {
    const { camera } = this;
    if (name === "home") camera.home();
    else camera.along(name);
    Object.assign(camera, { zoom: 1, shift: [0, 0] });
    this.resize();
    this.tellView?.();
  }
}

/** The smallest box round points, and round a box that is changed. */
function boxOf(points, box) {
  for (const p of points) {
    for (let axis = 0; axis < 3; axis += 1) {
      if (p[axis] < box[axis][0]) box[axis][0] = p[axis];
      if (p[axis] > box[axis][1]) box[axis][1] = p[axis];
    }
  }
  return box;
}

/** A wheel of the data: a circle about a point of a body, in space across an axis of the body. */
function wheelOf({ b, r, p, axis }) {
  const along = axis ?? [0, 0, 1];
  const first = unit(cross(along, Math.abs(along[0]) < 0.9 ? AXES.x : AXES.y));
  return { b, p: spatial(p ?? [0, 0, 0]), along, across: [first, cross(along, first)].map((a) => a.map((x) => r * x)), r };
}

/** The centre of a wheel and two of its arms, in ground axes. */
function wheelAt(wheel, poses) {
  const pose = poses.of(wheel.b);
  return { centre: pointOn(pose, wheel.p), across: view ? wheel.across.map((a) => turnedBy(pose.rows, a)) : wheel.across };
}
