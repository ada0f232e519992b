// A curve over time: axes with units, bands, one cursor for all charts, values where the pointer is.

/** All charts, so that one clock moves all cursors. */
const charts = [];

const MARGIN = { top: 8, right: 14, bottom: 34, left: 62 };
/** The lowest power of ten of an axis. */
const LEAST_DECADE = -18;
const DASHES = ["", "7 4", "2 3.5", "9 3 2 3", "4 3", "12 4", "1 4"];

/**
 * A curve: `values` at the frames, `colour` and `dash` as places in the palettes, `weak` for lines inside a band.
 * @typedef {{label: string, values: Float64Array, colour?: number, dash?: number, weak?: boolean, note?: string}} Series
 */

/** How a curve is stroked. */
function strokeOf(s) {
  return {
    class: `curve c${(s.colour ?? 0) % 7}${s.weak ? " weak" : ""}`,
    "stroke-dasharray": DASHES[(s.dash ?? 0) % DASHES.length],
  };
}

/** A line of a legend. */
function legendEntry(parent, s) {
  const key = draw(null, "svg", { viewBox: "0 0 28 12", class: "key", "aria-hidden": "true" });
  draw(key, "path", { d: "M0 6H28", ...strokeOf(s) });
  make(parent, "span", { className: "entry" }, key, s.label);
}

/** The unit of a chart and its number in one SI unit: that of the scene, or with a prefix. Tips show SI units, too. */
function printedUnit(si, range, floor) {
  if (data.units[si]) return data.units[si];
  const largest = Math.max(...(range ?? [0]).map(Math.abs), floor);
  const found = data.prefixed.includes(si.split(/[·/]/)[0]) && data.prefixes.find(([from]) => largest >= from);
  return found ? [`${found[1]}${si}`, 1 / found[2]] : [si, 1];
}

class Chart {
  /**
   * @param {HTMLElement} parent where the figure goes
   * @param {{title: string, unit: string, logarithmic?: boolean, height?: number, onSeek: (t: number) => void}} options
   */
  constructor(parent, options) {
    this.options = options;
    this.series = [];
    this.band = null;
    this.events = [];
    this.figure = make(parent, "figure", { className: "chart" });
    this.caption = make(this.figure, "figcaption");
    this.title = make(this.caption, "span", { className: "title", textContent: options.title });
    this.badge = make(this.caption, "span", { className: "badge" });
    this.menu = saveMenu(this);
    this.legend = make(this.figure, "div", { className: "legend" });
    this.svg = draw(null, "svg", { class: "plot", role: "img", tabindex: "-1" });
    this.figure.append(this.svg);
    this.tip = make(this.figure, "div", { className: "tip", hidden: true });
    this.height = options.height ?? 190;
    this.follow();
    new ResizeObserver(() => this.redraw()).observe(this.figure);
    // What nobody sees need not move.
    this.isSeen = true;
    new IntersectionObserver((entries) => {
      this.isSeen = entries.at(-1).isIntersecting;
      this.moveTo(clock.t);
    }).observe(this.figure);
    charts.push(this);
  }

  /**
   * Shows other curves.
   * @param {Series[]} series
   * @param {{low: Float64Array, high: Float64Array, label: string} | null} band
   */
  show(series, { band = null, title = null, unit = null, badge = null, floor = 0, legend = true } = {}) {
    if (title !== null) this.options.title = title;
    if (unit !== null) this.options.unit = unit;
    const curves = series.map((s) => s.values);
    const [name, factor] = this.options.logarithmic
      ? [this.options.unit, 1]
      : printedUnit(this.options.unit, rangeOf(band ? [...curves, band.low, band.high] : curves), floor);
    const scaled = (values) => (factor === 1 ? values : values.map((x) => factor * x));
    [this.unit, this.factor] = [name, factor];
    this.series = series.map((s) => ({ ...s, values: scaled(s.values) }));
    this.band = band && { ...band, low: scaled(band.low), high: scaled(band.high) };
    this.floor = factor * floor;
    const words = name ? `${this.options.title} (${name})` : this.options.title;
    this.title.textContent = words;
    this.menu.setAttribute("aria-label", `Save the chart ${words}`);
    this.badge.className = `badge ${badge ?? ""}`;
    this.badge.textContent = badge ? badge.replace("_", " ") : "";
    this.legend.replaceChildren();
    if (legend && series.length > 1) series.forEach((s) => legendEntry(this.legend, s));
    this.redraw();
  }

  /** The range of values that is shown. */
  range() {
    const curves = this.series.map((s) => s.values);
    if (this.band) curves.push(this.band.low, this.band.high);
    let [low, high] = rangeOf(curves) ?? [0, 1];
    if (this.options.logarithmic) {
      // What is smaller than rounding is not told apart: it lies on the lower edge.
      const top = Math.max(Math.ceil(high), LEAST_DECADE + 1);
      return [Math.min(Math.max(Math.floor(low), LEAST_DECADE), top - 1), top];
    }
    // What is zero everywhere is shown between −1 and 1. Ticks have six digits: smaller changes are shown as constant.
    const least = Math.max(this.floor, 2e-5 * Math.max(Math.abs(low), Math.abs(high))) || 1;
    if (high - low < least) {
      const half = Math.max(least, 0.05 * Math.abs(high));
      [low, high] = [(low + high) / 2 - half, (low + high) / 2 + half];
    }
    const pad = 0.06 * (high - low);
    return [low - pad, high + pad];
  }

  /** Draws the chart in a size (px): that on the screen, unless another one is given. */
  redraw([width, height] = [Math.max(this.figure.clientWidth, 240), this.height]) {
    this.box = {
      x: MARGIN.left, y: MARGIN.top,
      w: width - MARGIN.left - MARGIN.right, h: height - MARGIN.top - MARGIN.bottom,
    };
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("height", height);
    this.svg.setAttribute("aria-label", this.inWords());
    this.svg.replaceChildren();
    this.y = this.range();
    this.drawAxes();
    if (this.band) draw(this.svg, "path", { d: this.areaOf(this.band), class: "band" });
    for (const s of this.series) {
      draw(this.svg, "path", { d: this.lineOf(s.values), fill: "none", ...strokeOf(s) });
    }
    for (const event of data.events) {
      const x = this.toX(event.time);
      draw(this.svg, "path", { d: `M${x} ${this.box.y}v${this.box.h}`, class: "event" });
    }
    this.cursor = draw(this.svg, "path", { class: "cursor" });
    this.dots = this.series.map((s) => draw(this.svg, "circle", { r: 3.2, class: `dot c${(s.colour ?? 0) % 7}` }));
    this.moveTo(clock.t);
  }

  drawAxes() {
    const { x, y, w, h } = this.box;
    const axes = draw(this.svg, "g", { class: "axes" });
    const rows = this.options.logarithmic ? this.decades() : ticksOf(this.y, Math.max(h / 26, 2));
    for (const tick of rows) {
      const at = this.toY(tick);
      draw(axes, "path", { d: `M${x} ${at}h${w}`, class: "grid" });
      const label = this.options.logarithmic ? `1e${tick}` : spoken(tick, 6);
      draw(axes, "text", { x: x - 7, y: at + 4, "text-anchor": "end" }, label.replace("-", "−"));
    }
    for (const tick of ticksOf([tFirst, tLast], w / 80)) {
      const at = this.toX(tick);
      draw(axes, "path", { d: `M${at} ${y}v${h}`, class: "grid" });
      draw(axes, "text", { x: at, y: y + h + 16, "text-anchor": "middle" }, spoken(tick, 6));
    }
    draw(axes, "path", { d: `M${x} ${y}v${h}h${w}`, class: "frame" });
    draw(axes, "text", { x: x + w, y: y + h + 30, "text-anchor": "end", class: "unit" }, "t (s)");
  }

  /** At most eight powers of ten. */
  decades() {
    const [low, high] = this.y;
    const step = Math.max(Math.ceil((high - low) / 6), 1);
    const ticks = [];
    for (let k = Math.ceil(low / step) * step; k <= high; k += step) ticks.push(k);
    return ticks;
  }

  toX(t) {
    const span = tLast - tFirst || 1;
    return this.box.x + ((t - tFirst) / span) * this.box.w;
  }

  toY(value) {
    const [low, high] = this.y;
    const shown = this.options.logarithmic ? Math.max(value, low) : value;
    return this.box.y + this.box.h * (1 - (shown - low) / (high - low));
  }

  /** Path data; what is not finite is a gap. */
  lineOf(values) {
    let d = "";
    let pen = "M";
    for (let k = 0; k < frameCount; k += 1) {
      if (!Number.isFinite(values[k])) {
        pen = "M";
        continue;
      }
      d += `${pen}${this.toX(times[k]).toFixed(1)} ${this.toY(values[k]).toFixed(1)}`;
      pen = "L";
    }
    return d;
  }

  areaOf({ low, high }) {
    let d = "";
    let run = [];
    const close = () => {
      if (run.length > 1) {
        const at = (k, curve) => `${this.toX(times[k]).toFixed(1)} ${this.toY(curve[k]).toFixed(1)}`;
        const there = run.map((k) => at(k, high)).join("L");
        const back = run.reverse().map((k) => at(k, low)).join("L");
        d += `M${there}L${back}Z`;
      }
      run = [];
    };
    for (let k = 0; k < frameCount; k += 1) {
      if (Number.isFinite(low[k]) && Number.isFinite(high[k])) run.push(k);
      else close();
    }
    close();
    return d;
  }

  /** What a reader hears who does not see. */
  inWords() {
    const range = rangeOf([...this.series.map((s) => s.values), ...(this.band ? [this.band.low, this.band.high] : [])]);
    const value = (x) => (this.options.logarithmic ? spoken(10 ** x, 2) : spoken(x));
    const told = range ? `from ${value(range[0])} to ${value(range[1])}` : "no values";
    return `${this.title.textContent} over time, ${told}. ${this.series.map((s) => s.label).join(", ")}`;
  }

  /** Moves the cursor. */
  moveTo(t) {
    if (!this.box || !this.cursor || !this.isSeen) return;
    this.cursor.setAttribute("d", `M${this.toX(t).toFixed(1)} ${this.box.y}v${this.box.h}`);
    const instant = instantAt(t);
    this.series.forEach((s, k) => {
      const value = linear(s.values, instant);
      const visible = Number.isFinite(value) && !s.weak;
      this.dots[k].setAttribute("visibility", visible ? "visible" : "hidden");
      if (!visible) return;
      this.dots[k].setAttribute("cx", this.toX(t).toFixed(1));
      this.dots[k].setAttribute("cy", this.toY(value).toFixed(1));
    });
  }

  /** Values where the pointer is; a click or a drag sets the time. */
  follow() {
    const timeAt = (event) => {
      const box = this.svg.getBoundingClientRect();
      const share = (event.clientX - box.left - this.box.x) / this.box.w;
      return tFirst + Math.min(Math.max(share, 0), 1) * (tLast - tFirst);
    };
    this.svg.addEventListener("pointermove", (event) => {
      const t = timeAt(event);
      this.showTip(t, event);
      if (event.buttons & 1) this.options.onSeek(t);
    });
    this.svg.addEventListener("pointerdown", (event) => {
      this.svg.setPointerCapture(event.pointerId);
      this.options.onSeek(timeAt(event));
    });
    this.svg.addEventListener("pointerleave", () => {
      this.tip.hidden = true;
    });
  }

  showTip(t, event) {
    const k = nearestFrame(instantAt(t));
    const value = (x) => (this.options.logarithmic ? spoken(10 ** x, 2) : spoken(x, 5));
    this.tip.replaceChildren();
    make(this.tip, "b", { textContent: `t = ${spoken(times[k], 5)} s` });
    if (this.band) {
      const ends = `${value(this.band.low[k])} … ${value(this.band.high[k])}`;
      make(this.tip, "div", { textContent: `${this.band.label}: ${ends}` });
    }
    for (const s of this.series) {
      const line = make(this.tip, "div");
      make(line, "span", { className: `swatch c${(s.colour ?? 0) % 7}` });
      line.append(`${s.label}: `);
      make(line, "b", { textContent: value(s.values[k]) });
      if (this.factor !== 1) line.append(` ${this.unit} (${value(s.values[k] / this.factor)} ${this.options.unit})`);
    }
    this.tip.hidden = false;
    const box = this.figure.getBoundingClientRect();
    const x = event.clientX - box.left;
    const left = x > box.width / 2 ? x - this.tip.offsetWidth - 14 : x + 14;
    const top = Math.max(event.clientY - box.top - this.tip.offsetHeight - 10, 0);
    this.tip.style.left = `${Math.max(left, 0)}px`;
    this.tip.style.top = `${top}px`;
  }
}
