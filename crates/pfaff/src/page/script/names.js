// Names beside their places. Where each stands is chosen when the picture rests; it moves with its place, and one that would hide another is
// left out.

/** Distances from the place at which a name may stand (px). */
const NAME_DISTANCES = [14, 24, 36];

class Names {
  constructor(picture) {
    this.picture = picture;
    const { looks } = picture.brush;
    const of = (words, classes, size, at) => ({ words, size, at, look: () => looks.of("names", `text ${classes}`), offset: [14, -8] });
    this.all = [
      ...picture.sites.map((site) => of(site.joint.name, `name ${site.joint.verdict}`, 13, () => site.shown)),
      ...bodies.map((body) => of(body.name, "name body-name", 12, () => picture.camera.project(picture.poses.of(body.index).r))),
      ...data.drawing.markers.map(({ name, b, p }) => of(name, "name body-name", 12, () => picture.camera.project(pointOn(picture.poses.of(b), spatial(p))))),
    ];
  }

  /** Gives each name a side of its place where it covers nothing at this time. */
  place() {
    const { picture } = this;
    if (!picture.show.names) return;
    // Places are those of what is painted.
    picture.paint();
    const taken = new Boxes();
    for (const site of picture.sites) {
      const [x, y] = site.shown;
      taken.add([x - 11, y - 11, x + 11, y + 11]);
    }
    for (const name of this.all) {
      const [x, y] = name.at();
      const { size } = name;
      name.width = picture.brush.widthOf(name.words, name.look());
      const { width } = name;
      const spots = NAME_DISTANCES.flatMap((r) => [[r, -r * 0.6], [-r - width, -r * 0.6], [r, r + 4], [-r - width, r + 4], [-width / 2, -r - 3], [-width / 2, r + 12]]);
      const boxes = spots.map(([dx, dy]) => [x + dx, y + dy - size, x + dx + width, y + dy + 3]);
      const outside = (box) => Math.max(-box[0], 0, box[2] - picture.camera.page[0]) * size;
      const costs = boxes.map((box) => taken.covered(box) + outside(box));
      const best = costs.indexOf(Math.min(...costs));
      name.offset = spots[best];
      taken.add(boxes[best]);
    }
  }

  /** Chooses again once nothing has asked for a while. */
  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      if (clock.playing) return;
      this.place();
      this.picture.paint();
    }, 120);
  }

  paint() {
    const { brush } = this.picture;
    const taken = new Boxes();
    this.shown = [];
    for (const name of this.all) {
      const look = name.look();
      name.width ??= brush.widthOf(name.words, look);
      const [x, y] = name.at();
      const [left, base] = [x + name.offset[0], y + name.offset[1]];
      const box = [left, base - name.size, left + name.width, base + 3];
      if (taken.covered(box) > 0) continue;
      taken.add(box);
      this.shown.push(box);
      brush.text(name.words, left, base, look);
    }
  }
}

/** Boxes of the page, in cells, so that the neighbours of one are found without looking at all. */
class Boxes {
  constructor() {
    this.cells = new Map();
  }

  *cellsOf([x0, y0, x1, y1]) {
    for (let i = Math.floor(x0 / 64); i <= Math.floor(x1 / 64); i += 1) {
      for (let j = Math.floor(y0 / 64); j <= Math.floor(y1 / 64); j += 1) yield 65_536 * i + j;
    }
  }

  add(box) {
    if (!box.every(Number.isFinite)) return;
    for (const cell of this.cellsOf(box)) {
      if (!this.cells.has(cell)) this.cells.set(cell, []);
      this.cells.get(cell).push(box);
    }
  }

  /** How much of a box others cover (px²). */
  covered(box) {
    if (!box.every(Number.isFinite)) return Infinity;
    const others = new Set();
    for (const cell of this.cellsOf(box)) this.cells.get(cell)?.forEach((other) => others.add(other));
    let sum = 0;
    for (const other of others) sum += overlap(box, other);
    return sum;
  }
}

/** Common area of two boxes. */
function overlap(a, b) {
  const w = Math.min(a[2], b[2]) - Math.max(a[0], b[0]);
  const h = Math.min(a[3], b[3]) - Math.max(a[1], b[1]);
  return w > 0 && h > 0 ? w * h : 0;
}
