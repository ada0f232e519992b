// Bodies that the user drags in the picture. Each step asks for a pose that brings the dragged
// point to the pointer. The joints decide which pose the body takes.

/** A step must bring the point nearer at least by this share. */
const PROGRESS = 0.98;
/** A body that moves by less than this share of its size does not move. */
const MOVED = 1e-4;

const minus = (a, b) => a.map((x, k) => x - b[k]);
const plus = (a, b) => a.map((x, k) => x + b[k]);
const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
const cross = (a, b) => [0, 1, 2].map((k) => {
  const [i, j] = [(k + 1) % 3, (k + 2) % 3];
  return a[i] * b[j] - a[j] * b[i];
});

/** A vector, turned by a rotation vector. */
function turned(turn, v) {
  const angle = Math.hypot(...turn);
  if (angle < 1e-12) return v;
  const axis = turn.map((x) => x / angle);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [across, along] = [cross(axis, v), dot(axis, v)];
  return v.map((x, k) => c * x + s * across[k] + (1 - c) * along * axis[k]);
}

/** The product of the quaternion of a rotation vector and a quaternion. */
function turnedOrientation(turn, [w, x, y, z]) {
  const angle = Math.hypot(...turn);
  const share = angle < 1e-12 ? 0.5 : Math.sin(angle / 2) / angle;
  const [c, v, u] = [Math.cos(angle / 2), turn.map((t) => share * t), [x, y, z]];
  const vector = plus(plus(u.map((t) => c * t), v.map((t) => w * t)), cross(v, u));
  const product = [c * w - dot(v, u), ...vector];
  const size = Math.hypot(...product);
  return product.map((t) => t / size);
}

/**
 * The pose with the smallest change that brings a point of the body to another place. A turn by one
 * radian counts as much as a displacement by half the size of the body.
 */
export function wantedPose({ centre, frame, at, to, size, angle, orientation }) {
  const [arm, error] = [minus(at, centre), minus(to, at)];
  const inertia = dot(arm, arm) + (size / 2) ** 2;
  const turn = inertia > 0 ? cross(arm, error).map((x) => x / inertia) : [0, 0, 0];
  const moved = minus(plus(centre, error), cross(turn, arm));
  const position = plus(moved, turned(turn, minus(frame, centre)));
  if (orientation) return { position, orientation: turnedOrientation(turn, orientation) };
  return { position: position.slice(0, 2), angle: angle + turn[2] };
}

/** Moves bodies: one request at a time, the latest wins. */
export class Dragging {
  #next = null;
  #isBusy = false;
  #last = {};

  /**
   * @param {object} actions
   * @param {(body: string, pose: object) => Promise<void>} actions.place
   * @param {(end: {body: string, hasMoved: boolean}) => void} actions.drop
   */
  constructor(actions) {
    this.actions = actions;
  }

  grab() {
    this.#last = {};
    this.first = null;
    this.hasMoved = false;
    return true;
  }

  drag(detail) {
    this.first ??= detail;
    this.hasMoved ||= Math.hypot(...minus(detail.at, this.first.at)) > MOVED * detail.size;
    const far = Math.hypot(...minus(detail.to, detail.at));
    const goal = detail.to.join();
    const isStuck = goal === this.#last.goal && !(far < PROGRESS * this.#last.far);
    if (isStuck && !this.#isBusy) return;
    if (this.#isBusy) this.#next = detail;
    else this.#step(detail, { goal, far });
  }

  async #step(detail, last) {
    this.#isBusy = true;
    this.#last = last;
    await this.actions.place(detail.body, wantedPose(detail));
    this.#isBusy = false;
    const next = this.#next;
    this.#next = null;
    if (next) this.drag(next);
    else if (this.isDropped) this.#end();
  }

  drop() {
    this.isDropped = true;
    this.#next = null;
    if (!this.#isBusy) this.#end();
  }

  #end() {
    this.isDropped = false;
    if (this.first) this.actions.drop({ body: this.first.body, hasMoved: this.hasMoved });
  }
}
