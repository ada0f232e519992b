// First order about the start: free motions, swinging, and self-stresses, as loads that cancel.

/** How far a free motion swings: points by this share of the size of the picture, bodies by at most this angle (rad). */
const SWING = 0.09;
const SWING_TURN = 0.35;
/** Duration of a swing (s). */
const PERIOD = 2.4;

/** A function that displaces poses along velocities of the frames of bodies by an amount that changes. */
function swinging(velocities, size) {
  const n = view ? 3 : 2;
  const moving = new Map(velocities.map(([b, v]) => [b, { v: spatial(v.slice(0, n)), w: view ? v.slice(n) : [0, 0, v[n]] }]));
  const start = posesAt(instantAt(tFirst));
  let fastest = 0;
  let turns = 0;
  for (const [b, { v, w }] of moving) {
    const pose = start.of(b);
    const arms = [...bodies[b].outline, bodies[b].origin].map((p) => turnedBy(pose.rows, minus(p, bodies[b].origin)));
    fastest = Math.max(fastest, ...arms.map((arm) => norm(plus(v, cross(w, arm)))));
    turns = Math.max(turns, norm(w));
  }
  const most = Math.min(fastest > 0 ? (SWING * size) / fastest : Infinity, turns > 0 ? SWING_TURN / turns : Infinity);
  const swing = { amount: 0, most: Number.isFinite(most) ? most : 0 };
  swing.apply = (index, pose) => {
    const motion = moving.get(index);
    if (!motion) return pose;
    const { v, w } = motion;
    const s = swing.amount;
    const rows = turnedAbout(w, s * norm(w), pose.rows);
    // The origin of the frame moves along v; the centre of mass is carried.
    const origin = plus(pointOn(pose, bodies[index].origin), v, s);
    return { r: minus(origin, turnedBy(rows, bodies[index].origin)), rows };
  };
  return swing;
}

/** Rows of a rotation that is turned further about an axis of the ground. */
function turnedAbout(axis, angle, rows) {
  if (!(Math.abs(angle) > 0)) return rows;
  const a = unit(axis);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const columns = [0, 1, 2].map((k) => {
    const e = rows.map((row) => row[k]);
    const along = a.map((x) => x * dot3(a, e));
    return plus(plus(along, minus(e, along), c), cross(a, e), s);
  });
  return [0, 1, 2].map((row) => columns.map((column) => column[row]));
}

/** Buttons for free motions, and a choice of self-stresses. */
function setUpFirstOrder(picture) {
  const buttons = [];
  let running = null;
  const stop = () => {
    running = null;
    buttons.forEach((b) => b.setAttribute("aria-pressed", "false"));
    if (byId("stress")) byId("stress").value = "";
    byId("stress-loads")?.replaceChildren();
    if (picture.firstOrder) picture.showFirstOrder(null);
  };
  const begin = (firstOrder) => {
    stop();
    clock.pause();
    picture.showFirstOrder(firstOrder);
  };
  const diagonal = 2 * picture.camera.reach;
  data.motions.forEach((motion) => motion.velocities.forEach((velocities, k) => {
    const many = motion.velocities.length > 1 ? ` (${k + 1} of ${motion.velocities.length})` : "";
    const button = make(byId("motions"), "button", { type: "button" }, ...withNames(`${motion.lead}: ${motion.text}${many}`));
    button.setAttribute("aria-pressed", "false");
    buttons.push(button);
    button.addEventListener("click", () => {
      const again = button.getAttribute("aria-pressed") === "true";
      if (again) {
        stop();
        return;
      }
      const swing = swinging(velocities, diagonal);
      begin({ swing: swing.apply });
      button.setAttribute("aria-pressed", "true");
      running = swing;
      let first = null;
      const tick = (now) => {
        if (running !== swing) return;
        first ??= now;
        swing.amount = swing.most * Math.sin((2 * Math.PI * (now - first)) / 1000 / PERIOD);
        picture.paint();
        requestAnimationFrame(tick);
      };
      requestAnimationFrame(tick);
    });
  }));
  const select = byId("stress");
  data.stresses.forEach((stress, k) => make(select, "option", { value: k, textContent: `${k + 1}: ${stress.joints.map((j) => joints[j].name).join(", ")}` }));
  select?.addEventListener("change", () => {
    const chosen = data.stresses[select.value];
    if (!chosen) {
      stop();
      return;
    }
    const { value } = select;
    const sizes = (from, to) => Math.max(...chosen.wrenches.map((w) => Math.hypot(...w.slice(from, to))));
    begin({
      wrenches: new Map(chosen.joints.map((j, n) => [j, chosen.wrenches[n]])),
      large: { force: sizes(0, FORCES), torque: sizes(FORCES) },
    });
    select.value = value;
    showStress(chosen);
  });
  // The clock takes over.
  clock.listeners.push(() => picture.firstOrder && stop());
  return stop;
}

/** The loads of a self-stress in numbers. */
function showStress(stress) {
  const place = byId("stress-loads");
  make(place, "p", {}, ...withNames(stress.text));
  make(place, "p", { className: "grey", textContent: "Filled arrows show loads on the first body of a joint. Hollow arrows show loads on the other body. The loads on each body cancel." });
  const list = make(place, "ul");
  stress.joints.forEach((j, n) => {
    const loads = stress.wrenches[n].flatMap((x, k) => (Math.abs(x) > 1e-9 ? [`${COMPONENTS[k]} ${spoken(x, 3)}`] : []));
    make(list, "li", {}, make(null, "b", { textContent: joints[j].name }), ` on ${joints[j].bodies[0]}: ${loads.join(", ")}`);
  });
}
