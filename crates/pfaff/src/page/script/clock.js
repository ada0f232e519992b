// One clock for picture, curves and controls.

/** Time of what is shown, and who wants to know of it. */
const clock = {
  t: tFirst,
  playing: false,
  rate: 1,
  listeners: [],

  /** Goes to a time (s). */
  set(t) {
    this.t = Math.min(Math.max(t, tFirst), tLast);
    this.listeners.forEach((listener) => listener(this.t));
  },

  /** Goes so many frames further, or back. */
  step(count) {
    this.pause();
    const k = nearestFrame(instantAt(this.t)) + count;
    this.set(times[Math.min(Math.max(k, 0), frameCount - 1)]);
  },

  play() {
    if (this.playing || tLast <= tFirst) return;
    if (this.t >= tLast) this.set(tFirst);
    this.playing = true;
    this.last = null;
    this.shown = [];
    this.tell();
    requestAnimationFrame((now) => this.tick(now));
  },

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.tell();
  },

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  },

  tick(now) {
    if (!this.playing) return;
    const past = this.last === null ? 0 : Math.min(now - this.last, 100) / 1000;
    this.last = now;
    let t = this.t + past * this.rate;
    if (t > tLast) t = tFirst;
    this.set(t);
    this.count(now);
    requestAnimationFrame((next) => this.tick(next));
  },

  /** Pictures in the last second. */
  picturesPerSecond: 0,
  shown: [],

  count(now) {
    this.shown.push(now);
    while (this.shown[0] < now - 1000) this.shown.shift();
    const past = now - this.shown[0];
    if (past > 0) this.picturesPerSecond = (1000 * (this.shown.length - 1)) / past;
  },

  tell() {
    this.onChange?.(this.playing);
    if (!this.playing) this.onRest?.();
  },
};
