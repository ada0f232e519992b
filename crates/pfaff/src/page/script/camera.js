// How points of space come to the page: a turned view, in parallel lines or in perspective. The plane is seen along z and is not turned.

/** The eye of a perspective, as multiples of half the extent of what is seen. */
const EYE = 4;
/** What is nearer to the eye than this share of its distance is drawn as if it were there. */
const NEAREST = 0.08;
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

class Camera {
  constructor() {
    this.above = view ? view.above : AXES.y;
    this.isPerspective = false;
    this.home();
    Object.assign(this, { zoom: 1, shift: [0, 0], base: 1, page: [200, 200], focus: [0, 0, 0], reach: 1 });
  }

  /** The first view. */
  home() {
    this.standsAt = null;
    this.look(view ? view.right : AXES.x, view ? view.up : AXES.y);
  }

  look(right, up) {
    this.right = unit(right);
    this.up = unit(minus(up, this.right.map((x) => x * dot3(up, this.right))));
    this.towards = cross(this.right, this.up);
  }

  /** Along an axis of the ground: from the side where another axis runs to the right, and asked again, from the other side. */
  along(name) {
    const axis = AXES[name];
    const across = Object.values(AXES).find((a) => Math.abs(dot3(a, axis)) + Math.abs(dot3(a, this.above)) < 0.5);
    const isUpright = Math.abs(dot3(axis, this.above)) > 0.9;
    const other = this.standsAt === name;
    let right = isUpright ? (across ?? AXES.x) : cross(this.above, axis);
    if (!isUpright && Math.min(...right) < -0.5) right = right.map((x) => -x);
    if (other) right = right.map((x) => -x);
    const up = isUpright ? cross(other ? axis.map((x) => -x) : axis, right) : this.above;
    this.look(right, up);
    this.standsAt = other ? `−${name}` : name;
  }

  /** Turns about what is upright, and raises the eye; it goes no further than straight above or below. */
  orbit(turn, raise) {
    this.standsAt = null;
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    const about = (v) => {
      const along = this.above.map((x) => x * dot3(this.above, v));
      const level = minus(v, along);
      return plus(along, plus(level.map((x) => c * x), cross(this.above, level), s));
    };
    this.look(about(this.right), about(this.up));
    const height = Math.asin(Math.min(Math.max(dot3(this.towards, this.above), -1), 1));
    const goal = Math.min(Math.max(height + raise, -Math.PI / 2), Math.PI / 2);
    const [cr, sr] = [Math.cos(goal - height), Math.sin(goal - height)];
    this.look(this.right, minus(this.up.map((x) => cr * x), this.towards.map((x) => sr * x)));
  }

  /** Pixels of a metre at the focus. */
  get scale() {
    return this.base * this.zoom;
  }

  /** Prepares projections to a point of the page: what stands at the focus. */
  aim(focus) {
    this.focus = focus;
    this.origin = [this.page[0] / 2 + this.shift[0], this.page[1] / 2 + this.shift[1]];
    this.eye = this.isPerspective ? EYE * this.reach : Infinity;
  }

  /** How much larger a thing looks than at the focus, so near (m). */
  largerAt(near) {
    return this.isPerspective ? this.eye / Math.max(this.eye - near, NEAREST * this.eye) : 1;
  }

  /** The point of space at a place of the page (px), so near (m, from the focus to the eye). */
  pointAt([x, y], near) {
    const scale = this.scale * this.largerAt(near);
    const across = plus(this.focus, this.right, (x - this.origin[0]) / scale);
    return plus(plus(across, this.up, (this.origin[1] - y) / scale), this.towards, near);
  }

  /** A point on the page (px), how near it is (m, from the focus towards the eye), and how much larger it looks than at the focus. */
  project(p) {
    const [x, y, z] = [p[0] - this.focus[0], p[1] - this.focus[1], p[2] - this.focus[2]];
    const near = this.towards[0] * x + this.towards[1] * y + this.towards[2] * z;
    const larger = this.largerAt(near);
    const scale = this.scale * larger;
    return [
      this.origin[0] + scale * (this.right[0] * x + this.right[1] * y + this.right[2] * z),
      this.origin[1] - scale * (this.up[0] * x + this.up[1] * y + this.up[2] * z),
      near,
      larger,
    ];
  }

  /** A direction as it runs on the page: to the right and downwards, shorter than one where it is seen from the side. */
  direction(d) {
    return [dot3(d, this.right), -dot3(d, this.up)];
  }

  /** Where the eye is, in words. */
  inWords() {
    const kind = this.isPerspective ? "perspective projection" : "parallel projection";
    if (this.standsAt) return `View along ${this.standsAt}, ${kind}`;
    const toDegrees = (x) => Math.round((180 * x) / Math.PI);
    const height = toDegrees(Math.asin(Math.min(Math.max(dot3(this.towards, this.above), -1), 1)));
    return `View from ${Math.abs(height)}° ${height < 0 ? "below" : "above"}, ${kind}`;
  }
}
