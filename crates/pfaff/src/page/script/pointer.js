// Mouse, fingers and keys on the picture. In space one pointer turns the view and two move it; in the plane one moves it.

/** How far a pointer may move between down and up, and still be a click (px). */
const CLICK = 4;
/** How near a click must be to a symbol, and to a body in space (px). */
const REACH = 14;
const REACH_OF_BODY = 9;
/** How far a pixel of a drag and a press of a key turn the view (rad), and a press of a key moves it (px). */
const TURN = 0.009;
const KEY_TURN = Math.PI / 36;
const KEY_MOVE = 40;

/**
 * Sends an event to a page that shows this page in a frame.
 * @returns {boolean} whether that page acts on the event
 */
function announce(what, detail) {
  return !document.dispatchEvent(new CustomEvent(`pfaff:${what}`, { detail, cancelable: true }));
}

/** A body that a pointer drags. The page around this page moves the body. */
class Drag {
  /** The drag from a place of the page; `null` if no page around this page moves bodies. */
  static from(picture, at) {
    const index = targetAt(picture, at)?.body;
    const isTaken = index !== undefined && announce("grab", { body: bodies[index].name });
    return isTaken ? new Drag(picture, bodies[index], at) : null;
  }

  constructor(picture, body, at) {
    const pose = picture.poses.of(body.index);
    this.near = picture.camera.project(pose.r)[2];
    const arm = minus(picture.camera.pointAt(at, this.near), pose.r);
    const columns = [0, 1, 2].map((k) => pose.rows.map((row) => row[k]));
    Object.assign(this, { picture, body, at, arm: turnedBy(columns, arm) });
  }

  /** Announces where the body is and where its dragged point should be, in ground axes (m). */
  announce() {
    const { picture, body } = this;
    const pose = poseOf(body.index, picture.instant);
    announce("drag", {
      body: body.name,
      centre: pose.r,
      frame: pointOn(pose, body.origin),
      at: pointOn(pose, this.arm),
      to: picture.camera.pointAt(this.at, this.near),
      size: 2 * Math.max(...body.outline.map(norm), 0),
      ...(view ? { orientation: CURVES.slice(3, 7).map((name) => body[name][0]) } : { angle: body.angle[0] }),
    });
  }
}

function listen(picture, handlers) {
  const { canvas } = picture;
  const pointers = new Map();
  let moved = 0;
  const placeOf = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], far: Math.hypot(a[0] - b[0], a[1] - b[1]) };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, placeOf(event));
    moved = pointers.size > 1 ? Infinity : 0;
    drop();
    if (pointers.size === 1 && event.button === 0 && !event.shiftKey) picture.drag = Drag.from(picture, placeOf(event));
  });
  canvas.addEventListener("pointermove", (event) => {
    const at = placeOf(event);
    const before = pointers.get(event.pointerId);
    if (!before) {
      hover(picture, at, handlers);
      return;
    }
    const [dx, dy] = [at[0] - before[0], at[1] - before[1]];
    moved += Math.hypot(dx, dy);
    if (pointers.size === 2) {
      const old = spread();
      pointers.set(event.pointerId, at);
      const now = spread();
      picture.panBy(now.middle[0] - old.middle[0], now.middle[1] - old.middle[1]);
      if (old.far > 0) picture.zoomBy(now.far / old.far, now.middle);
      return;
    }
    pointers.set(event.pointerId, at);
    if (moved <= CLICK) return;
    if (picture.drag) {
      picture.drag.at = at;
      picture.drag.announce();
    } else if (view && !event.shiftKey && event.buttons !== 2 && event.buttons !== 4) picture.orbitBy(-TURN * dx, TURN * dy);
    else picture.panBy(dx, dy);
  });
  const drop = () => {
    if (picture.drag) announce("drop", { body: picture.drag.body.name, moved: moved > CLICK });
    picture.drag = null;
  };
  const gone = (event) => {
    pointers.delete(event.pointerId);
    drop();
  };
  canvas.addEventListener("pointerup", (event) => {
    if (pointers.size === 1 && moved <= CLICK) click(picture, placeOf(event), handlers);
    gone(event);
  });
  canvas.addEventListener("pointercancel", gone);
  canvas.addEventListener("contextmenu", (event) => view && event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    // The wheel alone scrolls the page, until somebody has chosen the picture.
    if (!event.ctrlKey && !event.metaKey && document.activeElement !== canvas) return;
    event.preventDefault();
    picture.zoomBy(Math.exp(-event.deltaY * 0.002), placeOf(event));
  }, { passive: false });
  canvas.addEventListener("dblclick", () => picture.zoomBy(0));
  canvas.addEventListener("keydown", (event) => keys(picture, event));
}

/** Keys while the picture is chosen; arrows go on to the clock in the plane. */
function keys(picture, event) {
  if (event.altKey || event.ctrlKey || event.metaKey) return;
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const arrow = arrows[event.key];
  const others = {
    "+": () => picture.zoomBy(1.3),
    "=": () => picture.zoomBy(1.3),
    "-": () => picture.zoomBy(1 / 1.3),
    "0": () => picture.zoomBy(0),
    ...(view ? {
      x: () => picture.stand("x"), y: () => picture.stand("y"), z: () => picture.stand("z"), i: () => picture.stand("home"),
      p: () => document.getElementById("perspective")?.click(),
    } : {}),
  };
  if (arrow && event.shiftKey) picture.panBy(-KEY_MOVE * arrow[0], -KEY_MOVE * arrow[1]);
  else if (arrow && view) {
    picture.orbitBy(KEY_TURN * arrow[0], -KEY_TURN * arrow[1]);
  } else if (others[event.key]) others[event.key]();
  else return;
  event.preventDefault();
  event.stopPropagation();
}

/** What is drawn at a place of the page: symbols first, then the nearest body. */
function targetAt(picture, [x, y]) {
  const near = picture.targets
    .filter((t) => t.at)
    .map((t) => ({ joint: t.joint, far: Math.hypot(t.at[0] - x, t.at[1] - y), near: t.at[2] }))
    .filter((t) => t.far < REACH);
  if (near.length) {
    near.sort((a, b) => a.far - b.far || b.near - a.near);
    return { joint: near[0].joint };
  }
  const { context } = picture.brush;
  context.save();
  context.setTransform(1, 0, 0, 1, 0, 0);
  const hit = picture.targets.filter((t) => t.body !== undefined).filter((t) => {
    t.path ??= roundedHull(hull(t.corners), REACH_OF_BODY * picture.symbolScale);
    return context.isPointInPath(t.path, x, y);
  });
  context.restore();
  if (!hit.length) return null;
  const nearness = (t) => (t.corners ? Math.max(...t.corners.map((c) => c[2])) : data.drawing.order.indexOf(t.body));
  return { body: hit.reduce((a, b) => (nearness(b) > nearness(a) ? b : a)).body };
}

function click(picture, at, handlers) {
  const target = targetAt(picture, at);
  if (target?.joint !== undefined) handlers.onJoint(target.joint);
  else if (target) handlers.onBody(target.body);
}

/** Names what is under the pointer. */
function hover(picture, at) {
  const target = targetAt(picture, at);
  const { canvas } = picture;
  const joint = joints[target?.joint];
  const words = joint ? `${joint.name} (${joint.type}): reaction ${joint.verdict.replace("_", " ")}` : bodies[target?.body]?.name ?? "";
  if (canvas.title !== words) canvas.title = words;
  canvas.classList.toggle("on-something", target !== null);
  if (picture.hovered !== target?.body) {
    picture.hovered = target?.body;
    picture.soon();
  }
}
