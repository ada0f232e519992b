// Puts the page together: controls, panels, curves, keys.

const byId = (id) => document.getElementById(id);

const seek = (t) => {
  clock.pause();
  clock.set(t);
};

/** Colours follow the system until somebody says otherwise. */
function setUpTheme() {
  const button = byId("theme");
  const isDark = () => (document.documentElement.dataset.theme
    ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  const tell = () => {
    button.textContent = isDark() ? "Light" : "Dark";
    button.setAttribute("aria-label", `Switch to the ${isDark() ? "light" : "dark"} theme`);
  };
  button.addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    tell();
    dispatchEvent(new Event("themechange"));
  });
  tell();
}

/** A round number of seconds of motion for one second, so that the run takes about eight seconds. */
function naturalRate() {
  const wanted = (tLast - tFirst) / 8;
  if (wanted > 0.4 && wanted < 4) return 1;
  const power = 10 ** Math.floor(Math.log10(wanted || 1));
  return Number((power * ([5, 2, 1].find((f) => f * power <= wanted) ?? 1)).toPrecision(3));
}

function setUpTransport() {
  const [play, scrub, time, speed] = ["play", "scrub", "time", "speed"].map(byId);
  Object.assign(scrub, { min: tFirst, max: tLast, step: (tLast - tFirst) / 2000 || 1, value: tFirst });
  const base = naturalRate();
  for (const factor of [0.1, 0.25, 0.5, 1, 2, 4]) {
    const rate = Number((factor * base).toPrecision(3));
    make(speed, "option", { value: rate, textContent: `${spoken(rate)}×`, selected: factor === 1 });
  }
  clock.rate = base;
  speed.addEventListener("change", () => {
    clock.rate = Number(speed.value);
  });
  play.addEventListener("click", () => clock.toggle());
  scrub.addEventListener("input", () => seek(Number(scrub.value)));
  clock.onChange = (playing) => {
    play.textContent = playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
  };
  clock.onChange(false);
  clock.listeners.push((t) => {
    scrub.value = t;
    scrub.setAttribute("aria-valuetext", `${timeInWords(t)} s`);
    time.textContent = `${timeInWords(t)} s`;
    byId("now").textContent = `t = ${timeInWords(t)} s`;
  });
  const marks = byId("marks");
  for (const event of data.events) {
    const left = (100 * (event.time - tFirst)) / (tLast - tFirst || 1);
    const mark = make(marks, "button", { title: `t = ${spoken(event.time)} s: ${event.text}`, type: "button" });
    mark.style.left = `${left}%`;
    mark.setAttribute("aria-label", `Go to ${event.kind} at ${spoken(event.time)} s`);
    mark.addEventListener("click", () => seek(event.time));
  }
}

function setUpKeys() {
  document.addEventListener("keydown", (event) => {
    const busy = event.target.closest?.("input, select, textarea, button, summary, a");
    if (event.altKey || event.ctrlKey || event.metaKey || (busy && busy.id !== "scrub")) return;
    const far = event.shiftKey ? 10 : 1;
    const actions = {
      " ": () => clock.toggle(),
      ArrowRight: () => clock.step(far),
      ArrowLeft: () => clock.step(-far),
      Home: () => seek(tFirst),
      End: () => seek(tLast),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  });
}

/** Check boxes for what the picture shows. */
function setUpOptions(picture) {
  const options = [
    ["forces", "Reactions"], ["freedom", "Undetermined directions"], ["names", "Names"],
    ["centres", "Centres of mass"], ["grid", "Grid"], ["follow", "Camera follows mechanism"],
  ];
  for (const [key, words] of options) {
    if (key === "follow" && !picture.travels) continue;
    if (key === "forces" && !joints.some((j) => j.reaction)) continue;
    if (key === "freedom" && !joints.some((j) => j.freedom)) continue;
    const box = make(null, "input", { type: "checkbox", checked: picture.show[key] });
    box.addEventListener("change", () => {
      picture.show[key] = box.checked;
      picture.resize();
    });
    make(byId("options"), "label", {}, box, words);
  }
  const rate = make(null, "input", { type: "checkbox" });
  rate.addEventListener("change", () => {
    byId("rate").hidden = !rate.checked;
  });
  make(byId("options"), "label", {}, rate, "Frames per second");
  clock.listeners.push(() => {
    if (!byId("rate").hidden) byId("rate").textContent = `${clock.picturesPerSecond.toFixed(0)} frames per second`;
  });
  for (const [id, factor] of [["zoom-in", 1.3], ["zoom-out", 1 / 1.3], ["zoom-reset", 0]]) {
    byId(id).addEventListener("click", () => picture.zoomBy(factor));
  }
}

/** Standard views of space, and the kind of projection. */
function setUpViews(picture) {
  const perspective = byId("perspective");
  if (!perspective) return;
  picture.tellView = () => {
    perspective.setAttribute("aria-pressed", picture.camera.isPerspective);
    byId("view").textContent = picture.camera.inWords();
  };
  for (const name of ["x", "y", "z", "home"]) {
    byId(`view-${name}`).addEventListener("click", () => picture.stand(name));
  }
  perspective.addEventListener("click", () => {
    picture.camera.isPerspective = !picture.camera.isPerspective;
    picture.resize();
    picture.tellView();
  });
  picture.tellView();
}

/** The length of arrows. */
function setUpArrows(picture) {
  byId("arrows").addEventListener("input", (event) => {
    picture.arrowScale = 2 ** Number(event.target.value);
    picture.moveTo(clock.t);
  });
}

/** Bodies and markers whose paths and curves are shown: at first the markers, if there are any. */
function setUpTracks(picture, refresh) {
  const list = byId("bodies");
  const boxes = tracks.map(({ index, name }) => {
    const box = make(null, "input", { type: "checkbox" });
    const swatch = make(null, "span", { className: `swatch c${index % 7}` });
    make(list, "label", {}, box, swatch, name);
    box.addEventListener("change", () => choose(index, box.checked));
    return box;
  });
  const choose = (index, wanted) => {
    boxes[index].checked = wanted;
    picture.trace(index, wanted);
    refresh();
  };
  const markers = tracks.slice(bodies.length).map(({ index }) => index);
  const first = markers.length ? markers.slice(0, 7) : [...new Set([0, bodies.length - 1])];
  first.filter((k) => k >= 0).forEach((k) => choose(k, true));
  return (index) => choose(index, !boxes[index].checked);
}

/** What a position is of, where all are of the same. */
const OF = tracks.some(({ p }) => p[0] || p[1]) ? "" : " of the centre of mass";

const QUANTITIES = {
  x: [`Position x${OF}`, "m"],
  y: [`Position y${OF}`, "m"],
  ...(view ? { z: [`Position z${OF}`, "m"] } : { angle: ["Angle", "rad"] }),
  vx: [`Velocity x${OF}`, "m/s"],
  vy: [`Velocity y${OF}`, "m/s"],
  ...(view ? {
    vz: [`Velocity z${OF}`, "m/s"],
    wx: ["Angular velocity x", "rad/s"],
    wy: ["Angular velocity y", "rad/s"],
    wz: ["Angular velocity z", "rad/s"],
  } : { omega: ["Angular velocity", "rad/s"] }),
};

/** Charts of the motion of the bodies and markers that are chosen: two in the plane, three in space. */
function setUpMotion(picture) {
  const panels = (view ? ["x", "y", "z"] : ["x", "angle"]).map((first, k) => {
    const letter = "abc"[k];
    const select = byId(`quantity-${letter}`);
    if (!select) return () => {};
    for (const [key, [words]] of Object.entries(QUANTITIES)) {
      make(select, "option", { value: key, textContent: words, selected: key === first });
    }
    const chart = new Chart(byId(`motion-${letter}`), { title: "", unit: "", onSeek: seek });
    const refresh = () => {
      const [title, unit] = QUANTITIES[select.value];
      const series = [...picture.traced].sort((a, b) => a - b).map((index, place) => ({
        label: tracks[index].name, values: tracks[index][select.value], colour: index % 7, dash: place,
      }));
      chart.show(series, { title, unit });
    };
    select.addEventListener("change", refresh);
    return refresh;
  });
  return () => panels.forEach((refresh) => refresh());
}

/** Curves of one reaction. What is not unique is a band between choices, never one line. */
function setUpReactions(picture) {
  const select = byId("joint");
  if (!select) return () => {};
  const groups = [["not_unique", "Not unique"], ["undecided", "Undecided"], ["unique", "Unique"]];
  const told = joints.filter((j) => j.reaction);
  for (const [verdict, words] of groups) {
    const members = told.filter((j) => j.verdict === verdict);
    if (!members.length) continue;
    const group = make(select, "optgroup", { label: words });
    for (const j of members) make(group, "option", { value: j.index, textContent: `${j.name} (${j.type})` });
  }
  const place = byId("reaction-curves");
  if (!told.length) {
    byId("reactions").hidden = true;
    return () => {};
  }
  const shown = COMPONENTS.map(() => new Chart(place, { title: "", unit: "", height: 180, onSeek: seek }));
  const large = picture.large.force;
  const refresh = () => {
    const joint = joints[Number(select.value)];
    picture.select(joint.index);
    byId("reaction-words").replaceChildren(...withNames(reactionInWords(joint)));
    showChoices(joint);
    const frame = byId("frame").value;
    COMPONENTS.forEach((name, k) => showComponent(shown[k], joint, name, k, { large, frame }));
  };
  select.addEventListener("change", refresh);
  byId("frame").addEventListener("change", refresh);
  refresh();
  return (index) => {
    if (!joints[index].reaction) return;
    select.value = String(index);
    refresh();
  };
}

/** The same curves for all joints and drives, drawn when somebody opens the appendix. */
function setUpAllReactions(picture) {
  const appendix = byId("all-reactions");
  if (!appendix) return;
  appendix.hidden = !joints.some((j) => j.reaction);
  appendix.addEventListener("toggle", () => {
    if (!appendix.open || appendix.dataset.drawn) return;
    appendix.dataset.drawn = "true";
    const frame = byId("frame").value;
    for (const joint of joints.filter((j) => j.reaction)) {
      const place = byId("all-curves");
      make(place, "h4", { textContent: `${joint.name} (${joint.type})` });
      showChoices(joint, make(place, "div", { className: "legend" }));
      const curves = make(place, "div", { className: "curves" });
      COMPONENTS.forEach((name, k) => {
        const chart = new Chart(curves, { title: "", unit: "", height: 150, onSeek: seek });
        showComponent(chart, joint, name, k, { large: picture.large.force, frame });
      });
    }
  });
}

/** One legend for all components. */
function showChoices(joint, legend = byId("reaction-legend")) {
  legend.replaceChildren();
  if (!joint.choices.length && !Object.keys(joint.bands).length) return;
  const key = draw(null, "svg", { viewBox: "0 0 28 12", class: "key", "aria-hidden": "true" });
  draw(key, "rect", { x: 0, y: 1, width: 28, height: 10, class: "band" });
  make(legend, "span", { className: "entry" }, key, bandLabel(joint));
  joint.choices.forEach((choice, place) => legendEntry(legend, choiceSeries(choice, place, null)));
}

/** What the bands of a reaction contain; along the axes of a body no bounds are drawn. */
function bandLabel(joint, name = null) {
  const hasBounds = name ? joint.bands[name] : Object.keys(joint.bands).length > 0 && byId("frame").value !== "body";
  return hasBounds ? "bounds for joints of any stiffness" : "range of the compared choices";
}

function choiceSeries(choice, place, values) {
  return { label: choice.label, values, colour: place + 1, dash: place + 1, weak: true };
}

function reactionInWords(joint) {
  const on = `The curves show the force and torque on \`${joint.bodies[0]}\` at the reference point of \`${joint.name}\`.`;
  if (joint.verdict === "unique") return `${on} The reaction is unique: the model determines these values.`;
  if (joint.verdict === "undecided") return `${on} The verdict on this reaction is undecided.`;
  const why = joint.explanation ? ` At the start, ${joint.explanation}.` : "";
  const compared = Object.keys(joint.bands).length
    ? " Each band contains the values for joints of any stiffness that fit exactly; the file summary.json states the assumptions. Along the axes of the body, it extends from the smallest to the largest value of the compared choices."
    : joint.choices.length
    ? " Each band extends from the smallest to the largest value of the compared choices. Other choices can give values outside the band."
    : " No choices were compared for this reaction. Components that are not unique therefore have no curve.";
  return `${on}${why}${determinedInWords(joint)}${compared}`;
}

/** Components that are determined on some intervals only. */
function determinedInWords(joint) {
  const some = joint.components.filter((c) => c.determined?.length);
  const on = (c) => c.determined.map(([from, to]) => `${spoken(from)} … ${spoken(to)} s`).join(", ");
  return some.length ? ` Components that are determined on parts of the run: ${some.map((c) => `${c.name} on ${on(c)}`).join("; ")}.` : "";
}

/** A wrench along the axes of a body. */
function turned(wrench, body) {
  if (body < 0) return wrench;
  if (view) {
    const { qw, qx, qy, qz } = bodies[body];
    const axes = Array.from(times, (_, f) => rotation([qw[f], qx[f], qy[f], qz[f]]));
    return wrench.map((values, c) => {
      const first = c - (c % 3);
      return values.map((_, f) => [0, 1, 2].reduce((sum, j) => sum + axes[f][j][c % 3] * wrench[first + j][f], 0));
    });
  }
  const [x, y, torque] = wrench;
  const { angle } = bodies[body];
  const along = (a, b, sign) => x.map((_, k) => a[k] * Math.cos(angle[k]) + sign * b[k] * Math.sin(angle[k]));
  return [along(x, y, 1), along(y, x, -1), torque];
}

/** One component of a reaction in its chart: global, or along the first body. */
function showComponent(chart, joint, name, k, { large, frame }) {
  const inBody = frame === "body" && (view || k < FORCES);
  const wrenchOf = (wrench) => (inBody ? turned(wrench, joint.site.bodies[0]) : wrench)[k];
  const [, unit] = data.components[k];
  const loads = joint.components.some((c) => c.unit === unit);
  const known = inBody ? loads : joint.components.some((c) => c.name === name);
  const verdict = verdictOf(joint, name, inBody);
  const determined = verdict === "unique";
  const source = inBody && joint.verdict !== "unique" ? chosenWrench(joint) : joint.wrench;
  const own = wrenchOf(source);
  const partly = !inBody && !determined && own.some(Number.isFinite);
  const bounds = inBody ? null : joint.bands[name];
  const present = known && (determined || partly || bounds || joint.choices.length > 0);
  chart.figure.hidden = !present;
  if (!present) return;
  // The curves of the page are rounded: turned, what is zero shows that rounding, which no axis should fill.
  const floor = (inBody ? 0.02 : 1e-9) * large;
  const options = { title: inBody ? `${joint.name}, ${unit === "N" ? "force along" : "torque about"} ${"xyz"[k % FORCES]} of ${joint.bodies[0]}` : `${joint.name}.${name}`, unit, badge: verdict, floor, legend: false };
  if (determined) {
    chart.show([{ label: `${name}, unique`, values: own, colour: 0 }], options);
    return;
  }
  const curves = joint.choices.map((choice) => wrenchOf(choice.wrench));
  const at = (of) => Float64Array.from({ length: frameCount }, (_, f) => {
    const values = curves.map((c) => c[f]).filter(Number.isFinite);
    return values.length ? of(...values) : NaN;
  });
  const band = bounds
    ? { low: bounds[0], high: bounds[1], label: bandLabel(joint, name) }
    : { low: at(Math.min), high: at(Math.max), label: "range of the compared choices" };
  const series = joint.choices.map((choice, place) => choiceSeries(choice, place, curves[place]));
  if (partly) series.unshift({ label: `${name} (determined values only)`, values: own, colour: 0 });
  chart.show(series, { ...options, band });
}

/** Sums of reactions, plots, measures, loads, drives. */
function setUpCharts(picture) {
  for (const { place, title, unit, curves, badge, band } of data.charts) {
    const chart = new Chart(byId(place), { title, unit, onSeek: seek });
    const [low, high] = band?.map(decode) ?? [];
    const floor = unit.startsWith("N") ? 1e-9 * picture.large.force : 0;
    chart.show(
      // Colours and dashes repeat after seven, and both together after forty-nine.
      curves.map(([label, channel], k) => ({ label, values: decode(channel), colour: k % 7, dash: k + Math.floor(k / 7) })),
      { badge, floor, band: band ? { low, high, label: "bounds for joints of any stiffness" } : null },
    );
  }
}

/** All curves of the page that the model determines: their names, units and values. */
function* curvesOfPage() {
  for (const joint of joints.filter((j) => j.reaction)) {
    const { component, unit: unitOfNamed, named } = joint.reaction;
    if (named !== undefined) {
      yield { kind: "Reactions", label: `${joint.name}.${component}`, unit: unitOfNamed, values: () => decode(named) };
    }
    for (const { name, unit } of joint.components) {
      yield { kind: "Reactions", label: `${joint.name}.${name}`, unit, values: () => joint.wrench[COMPONENTS.indexOf(name)] };
    }
  }
  const kinds = { "group-curves": "Groups", "measure-curves": "Measures", "load-curves": "Force elements", "drive-curves": "Drives" };
  for (const { place, title, unit, curves } of data.charts.filter((chart) => kinds[chart.place])) {
    for (const [label, channel] of curves) {
      yield { kind: kinds[place], label: place === "load-curves" ? `${title}.${label}` : label, unit, values: () => decode(channel) };
    }
  }
  for (const track of tracks) {
    for (const [key, [, unit]] of Object.entries(QUANTITIES)) {
      yield { kind: "Motion", label: `${track.name}.${key}`, unit, values: () => track[key] };
    }
  }
}

/** A plot of the curves that a reader chooses, all of one unit. */
function setUpOwnPlot() {
  const select = byId("own-curve");
  if (!select) return;
  const chart = new Chart(byId("own-chart"), { title: "", unit: "", onSeek: seek });
  const all = [...curvesOfPage()].filter(({ values }) => values().some(Number.isFinite));
  const chosen = [];
  const refresh = () => {
    const left = all.filter((curve) => !chosen.includes(curve) && (!chosen.length || curve.unit === chosen[0].unit));
    select.replaceChildren(make(null, "option", { value: "", textContent: left.length ? "choose …" : "no other curve of this unit" }));
    for (const kind of new Set(left.map((curve) => curve.kind))) {
      const group = make(select, "optgroup", { label: kind });
      for (const curve of left.filter((c) => c.kind === kind)) make(group, "option", { value: all.indexOf(curve), textContent: curve.label });
    }
    byId("own-plot").classList.toggle("filled", chosen.length > 0);
    chart.figure.hidden = chosen.length === 0;
    if (!chosen.length) return;
    chart.show(
      chosen.map(({ label, values }, k) => ({ label, values: values(), colour: k % 7, dash: k + Math.floor(k / 7) })),
      { title: chosen.map(({ label }) => label).join(", "), unit: chosen[0].unit },
    );
  };
  select.addEventListener("change", () => {
    if (select.value !== "") chosen.push(all[Number(select.value)]);
    refresh();
  });
  byId("own-clear").addEventListener("click", () => {
    chosen.length = 0;
    refresh();
  });
  refresh();
}

/** Energy and residuals. */
function setUpChecks() {
  if (!byId("energy-curves")) return;
  const energy = new Chart(byId("energy-curves"), { title: "Energy", unit: "J", onSeek: seek });
  const [kinetic, potential, work] = [data.energy.kinetic, data.energy.potential, data.energy.work].map(decode);
  const parts = [
    { label: "kinetic energy", values: kinetic, colour: 0, dash: 0 },
    { label: "potential energy of gravity", values: potential, colour: 2, dash: 1 },
    { label: "work of drives and applied forces", values: work, colour: 1, dash: 2 },
  ];
  energy.show(parts.filter((s, k) => k === 0 || s.values.some((x) => x !== 0)));
  const checks = [
    ["Energy error", "relative to kinetic energy", [["|E − E₀ − work| / largest kinetic energy", data.energy.gap]]],
    ["Constraint residuals", "m, rad and m/s, rad/s", [["largest |Φ|", data.residuals.position], ["largest |C·v − b|", data.residuals.velocity]]],
  ];
  for (const [title, unit, curves] of checks) {
    const chart = new Chart(byId("energy-curves"), { title, unit, logarithmic: true, onSeek: seek });
    chart.show(curves.map(([label, channel], k) => ({ label, values: decode(channel), colour: k, dash: k })));
  }
}

/** Size of the picture on paper in pixels of the page, that of A4 without its margins, and pixels of paper for one of these. */
const PAPER = [688, 359, 3];
/** Size of a chart on paper in pixels of the page: of one that stands alone, and of one of two. */
const PAPER_CHART = { alone: [688, 190], ofTwo: [335, 150] };

/** Paper has no folded parts and no second frame, and is light. */
function setUpPrint() {
  let folded = [];
  let theme;
  const picture = () => globalThis.pfaffReport?.picture;
  addEventListener("beforeprint", () => {
    clock.pause();
    folded = [...document.querySelectorAll("details:not([open]):not(.on-request)")];
    folded.forEach((d) => { d.open = true; });
    theme = document.documentElement.dataset.theme;
    document.documentElement.dataset.theme = "light";
    picture()?.printTo(...PAPER);
    charts.forEach((chart) => chart.redraw(chart.figure.closest(".curves") ? PAPER_CHART.ofTwo : PAPER_CHART.alone));
  });
  addEventListener("afterprint", () => {
    folded.forEach((d) => { d.open = false; });
    if (theme === undefined) delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    picture()?.brush.looks.refresh();
    picture()?.resize();
    charts.forEach((chart) => chart.redraw());
  });
}

/** Names move with their places; where the picture rests they are placed anew. */
function placeNamesAtRest(picture) {
  const later = () => !clock.playing && picture.names.later();
  clock.onRest = () => {
    picture.soon();
    later();
  };
  clock.listeners.push(later);
}

/** The symbols that occur, with the types of joints that they stand for. */
function showSymbols() {
  const place = byId("symbols");
  const shown = new Map();
  for (const { site, type } of joints) {
    if (!shown.has(site.symbol)) shown.set(site.symbol, new Set());
    shown.get(site.symbol).add(type);
  }
  for (const [symbol, types] of shown) {
    const [[x, y], middle] = data.drawing.shapes[symbol];
    const [width, height] = [2 * x + 4, 2 * y + 4];
    const key = draw(null, "svg", { viewBox: `${-x - 2} ${middle - y - 2} ${width} ${height}`, width, height, class: "symbol", "aria-hidden": "true" });
    drawSymbol(draw(key, "g", { class: "site plain" }), symbol);
    make(place, "span", { className: "entry" }, key, [...types].join(", "));
  }
}

/** What only a run has: time, curves, traces. */
function setUpRun(picture, handlers) {
  setUpTransport();
  const refresh = setUpMotion(picture);
  handlers.body = setUpTracks(picture, refresh);
  handlers.joint = setUpReactions(picture);
  setUpAllReactions(picture);
  setUpArrows(picture);
  setUpCharts(picture);
  setUpOwnPlot();
  setUpChecks();
  setUpKeys();
}

/** Events of a page that shows this page in a frame. */
function listenToHost(picture, handlers) {
  document.addEventListener("pfaff:select", ({ detail }) => {
    const index = joints.findIndex(({ name }) => name === detail.joint);
    if (index >= 0) handlers.joint?.(index);
    picture.select(index);
  });
  document.addEventListener("pfaff:start", ({ detail }) => picture.startFrom(detail));
}

function start() {
  setUpTheme();
  setUpPrint();
  if (!frameCount) return;
  const handlers = {};
  const picture = new Picture(byId("picture"), {
    onJoint: (index) => {
      handlers.joint?.(index);
      picture.select(index);
      announce("selected", { joint: joints[index].name });
    },
    onBody: (index) => {
      handlers.body?.(index);
      announce("selected", { body: bodies[index].name });
    },
  });
  listenToHost(picture, handlers);
  setUpOptions(picture);
  setUpViews(picture);
  setUpSave(picture);
  setUpFirstOrder(picture);
  placeNamesAtRest(picture);
  showSymbols();
  if (byId("arrows")) setUpRun(picture, handlers);
  else if (byId("play")) {
    setUpTransport();
    setUpKeys();
  }
  clock.listeners.push((t) => picture.moveTo(t), (t) => charts.forEach((chart) => chart.moveTo(t)));
  clock.set(tFirst);
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) clock.play();
  // For tests, and for the curious.
  globalThis.pfaffReport = { clock, picture, charts, data };
}

start();
