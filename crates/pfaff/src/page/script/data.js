// The data of the page: curves from their differences, joints with their reactions, and numbers as people write them.

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

/** A property that is computed when somebody asks for it. */
function defineLazily(object, name, compute) {
  Object.defineProperty(object, name, {
    configurable: true,
    enumerable: true,
    get() {
      const value = compute();
      Object.defineProperty(object, name, { value, enumerable: true });
      return value;
    },
  });
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

/** Names of the components of a reaction; those of the force come first. */
const COMPONENTS = data.components.map(([name]) => name);
const FORCES = data.components.filter(([, unit]) => unit === "N").length;

/** Joints and drives with decoded reactions, and what choices say of them. */
const joints = data.joints.map((joint, index) => {
  const own = { ...joint, index, site: data.drawing.sites[index], choices: [], freedom: null };
  defineLazily(own, "bands", () => Object.fromEntries(Object.entries(joint.bounds ?? {}).map(([name, ends]) => [name, ends.map(decode)])));
  defineLazily(own, "wrench", () => joint.reaction?.wrench.map(decode) ?? null);
  return own;
});

for (const comparison of data.comparisons) {
  comparison.joints.forEach((k, place) => {
    const freedom = comparison.freedom[place];
    joints[k].freedom = { ...freedom, angle: decode(freedom.angle) };
    joints[k].choices = comparison.choices.map((choice) => {
      const own = { label: choice.label };
      defineLazily(own, "wrench", () => choice.wrenches[place].map(decode));
      return own;
    });
  });
}

/**
 * The verdict of a component: of the run, or at the start alone. A component that is not listed is zero under any load. Components along the
 * axes of a body are judged where choices were compared.
 */
function verdictOf(joint, name, inBody = false) {
  if (joint.verdict === "unique") return "unique";
  if (inBody && joint.freedom) return joint.freedom.in_body[COMPONENTS.indexOf(name)] ? "not_unique" : "unique";
  if (inBody) return joint.verdict;
  return joint.components.find((c) => c.name === name)?.verdict ?? "unique";
}

/** The numbers of one choice, where there are any; otherwise those that are determined. */
const chosenWrench = (joint) => joint.choices[0]?.wrench ?? joint.wrench;

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

/** A time of the run (s): all have as many decimals. */
function timeInWords(t) {
  const decimals = Math.max(0, 3 - Math.floor(Math.log10(tLast || 1)));
  return t.toFixed(Math.min(decimals, 9));
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
