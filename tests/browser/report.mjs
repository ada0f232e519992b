// Opens reports in headless Chromium and looks whether they live: no errors, a picture that moves and, in space, turns and hides what is
// behind, curves with content, a dark page, a phone, paper, and files of the picture and of a chart. Run by `cargo xtask browser`, or as
//   node tests/browser/report.mjs CHROMIUM PICTURES NAME=report.html ...
// The pages named `crossing`, `crowd` and `customer` are those of xtask/src/browser.rs: two bars that cross, a thousand bodies, and a report
// for a customer with plots and sums.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { Browser } from "./devtools.mjs";

const [program, pictures, ...reports] = process.argv.slice(2);

/** Time for scripts and layout (ms). */
const SETTLED = 400;

/** A crowd may take this long to be shown (ms); it blocked for 20 s once. */
const CROWD_LOAD = 5000;

/** Least rate of a crowd (1/s). Thirty are the aim, and are reached where nothing else runs; this is what a machine at work leaves of it. */
const CROWD_RATE = 12;

/** Two pixels differ if a channel of theirs differs by more than this, of 255: a quarter, as edges are smoothed in other ways. */
const PIXEL_DIFFERS = 64;

/**
 * Less than this share of what is painted differs in a saved SVG (0.5 % do, and 1.1 % where the words of the smallest picture are lost) and in a
 * PNG, of which two pixels are averaged (1.7 %).
 */
const DIFFER = { svg: 0.008, png: 0.03 };

/** The same in a crowd (3.9 % and 7.3 %), whose symbols stand on the screen at whole pixels, turned by whole steps. */
const CROWD_DIFFERS = { svg: 0.06, png: 0.1 };

/** Browsers at a time. */
const BROWSERS = 4;

const wait = (ms) => new Promise((done) => {
  setTimeout(done, ms);
});

const hash = (bytes) => createHash("sha256").update(bytes).digest("hex");

/** Opens a report as a reader with these preferences and this window sees it. */
async function opened(browser, file, { width = 1400, height = 1050, mobile = false, prefers = {} } = {}) {
  const page = await browser.page(width, height);
  if (mobile) {
    await page.resize(width, height, true);
    await page.send("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 2 });
  }
  await page.prefer({ "prefers-color-scheme": "light", "prefers-reduced-motion": "reduce", ...prefers });
  await page.open(pathToFileURL(resolve(file)).href);
  await wait(SETTLED);
  return page;
}

/** Nothing went wrong and nothing was fetched. */
function assertQuiet(page) {
  assert.deepEqual(page.complaints, [], "errors on the page");
  const fetched = page.requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:"));
  assert.deepEqual(fetched, [], "requests");
  assert.equal(page.requests.filter((url) => url.startsWith("file:")).length, 1, "one file");
}

const at = (page) => page.value("pfaffReport.clock.t");
const seek = async (page, share) => {
  await page.value(`pfaffReport.clock.set(${share} * pfaffReport.data.t.at(-1))`);
  await wait(SETTLED);
};

async function movesAndScrubs(page) {
  assert.equal(await page.value("pfaffReport.clock.playing"), false, "less motion: nothing plays by itself");
  await seek(page, 0);
  const before = hash(await page.picture());
  await seek(page, 0.6);
  assert.notEqual(hash(await page.picture()), before, "another time looks different");

  const t = await at(page);
  await page.press("ArrowRight");
  assert.ok((await at(page)) > t, "an arrow key goes a frame further");
  await page.press("ArrowLeft");
  await page.press("Home");
  assert.equal(await at(page), await page.value("pfaffReport.data.t[0]"), "Home goes to the start");
  await page.press(" ", "Space");
  await wait(3 * SETTLED);
  assert.equal(await page.value("pfaffReport.clock.playing"), true, "space plays");
  const playing = await at(page);
  assert.ok(playing > 0, "time goes on");
  await page.press(" ", "Space");
  const rest = await at(page);
  await wait(SETTLED);
  assert.equal(await at(page), rest, "space stops it");

  await page.value(`(() => {
    const scrub = document.getElementById("scrub");
    scrub.value = 0.25 * scrub.max;
    scrub.dispatchEvent(new Event("input"));
  })()`);
  const quarter = 0.25 * (await page.value("pfaffReport.data.t.at(-1)"));
  assert.ok(Math.abs((await at(page)) - quarter) <= 0.002 * 4 * quarter, "the slider sets the time");
}

async function curvesHaveContent(page, least = 5) {
  const charts = await page.value(`[...document.querySelectorAll(".chart:not([hidden])")].map((chart) => ({
    title: chart.querySelector(".title").textContent,
    curves: [...chart.querySelectorAll(".plot > path.curve")].map((p) => p.getAttribute("d").length),
    labels: [...chart.querySelectorAll(".axes text")].map((t) => t.textContent),
    words: chart.querySelector(".plot").getAttribute("aria-label"),
    bands: chart.querySelectorAll(".plot > path.band").length,
    open: chart.querySelector(".badge.not_unique") !== null,
  }))`);
  assert.ok(charts.length >= least, `${charts.length} charts`);
  for (const chart of charts) {
    assert.ok(chart.curves.length > 0, `${chart.title}: no curve`);
    assert.ok(chart.labels.includes("t (s)") && chart.labels.length > 4, `${chart.title}: no labels`);
    assert.ok(chart.words.includes("over time"), `${chart.title}: no words`);
    if (chart.open) assert.equal(chart.bands, 1, `${chart.title}: not unique, and no band`);
  }
  const empty = charts.filter((chart) => chart.curves.every((length) => length === 0));
  // Residuals that are exactly zero have no logarithm.
  assert.ok(empty.every((chart) => /residuals|balance/.test(chart.title)), `empty: ${empty.map((c) => c.title)}`);
}

/** What is smaller than rounding stretches no axis: a residual of 1e-312 lies on its lower edge. */
async function axesEndAtRounding(page) {
  const least = await page.value(`(() => {
    const chart = pfaffReport.charts.find((c) => c.options.logarithmic);
    const { series } = chart;
    const values = new Float64Array(pfaffReport.data.t.length).fill(-8);
    values[0] = -312;
    chart.show([{ label: "tiny", values }]);
    const labels = [...chart.svg.querySelectorAll(".axes text")].map((t) => t.textContent);
    chart.show(series);
    const powers = labels.filter((l) => l.startsWith("1e")).map((l) => Number(l.slice(2).replace("−", "-")));
    return Math.min(...powers);
  })()`);
  assert.ok(least >= -18, `an axis down to 1e${least}`);
}

/** Each joint in turn: what is not unique has a band or no curve, never a line alone. */
async function noBareLines(page) {
  const bare = await page.value(`(() => {
    const [select, frame] = ["joint", "frame"].map((id) => document.getElementById(id));
    const bare = [];
    const cases = [...select.options].flatMap((o) => ["body", "global"].map((f) => [o.value, o.text, f]));
    for (const [value, text, axes] of cases) {
      select.value = value;
      frame.value = axes;
      select.dispatchEvent(new Event("change"));
      for (const chart of document.querySelectorAll("#reaction-curves .chart:not([hidden])")) {
        const open = !chart.querySelector(".badge.unique");
        if (open && !chart.querySelector(".plot > path.band")) bare.push(text);
      }
    }
    return bare;
  })()`);
  assert.deepEqual(bare, [], "lines without a band");
}

async function tipsTellValues(page) {
  await page.value(`document.querySelector("#energy-curves .plot").scrollIntoView({ block: "center" })`);
  const [x, y] = await page.value(`(() => {
    const box = document.querySelector("#energy-curves .plot").getBoundingClientRect();
    return [box.x + 0.5 * box.width, box.y + 0.4 * box.height];
  })()`);
  await page.move(x, y);
  await wait(100);
  const tip = await page.value(`document.querySelector("#energy-curves .tip").textContent`);
  assert.match(tip, /^t = .* s.*kinetic/, "values where the pointer is");
  await page.move(2, 2);
  await page.value("scrollTo(0, 0)");
}

/** What the picture shows, as one string. */
const drawn = (page) => page.value(`document.getElementById("picture").toDataURL()`);

/** Presses on the picture and moves to another place of it. */
async function drag(page, from, to, modifiers = 0) {
  const [left, top] = await page.value(`(() => {
    const box = document.getElementById("picture").getBoundingClientRect();
    return [box.x, box.y];
  })()`);
  const at = ([x, y]) => ({ x: left + x, y: top + y, button: "left", modifiers });
  await page.send("Input.dispatchMouseEvent", { type: "mousePressed", ...at(from), clickCount: 1 });
  for (const share of [0.25, 0.5, 1]) {
    const on = from.map((x, k) => x + share * (to[k] - x));
    await page.send("Input.dispatchMouseEvent", { type: "mouseMoved", ...at(on), buttons: 1 });
  }
  await page.send("Input.dispatchMouseEvent", { type: "mouseReleased", ...at(to), clickCount: 1 });
  await page.move(left + to[0] + 1, top + to[1]);
  await wait(SETTLED);
}

/** Space turns by mouse and keys, the plane does not; both move and zoom. */
async function turnsAndZooms(page) {
  const isSpatial = await page.value(`document.querySelector(".spatial") !== null`);
  const rows = () => page.value("[pfaffReport.picture.camera.right, pfaffReport.picture.camera.up]");
  const shift = () => page.value("pfaffReport.picture.camera.shift");
  await page.value(`document.getElementById("picture").scrollIntoView({ block: "center" })`);
  const before = [await rows(), await shift(), await drawn(page)];
  await drag(page, [300, 300], [360, 330]);
  if (isSpatial) {
    assert.notDeepEqual(await rows(), before[0], "a drag turns space");
    assert.deepEqual(await shift(), before[1], "and does not move it");
    await drag(page, [300, 300], [360, 330], 8);
    assert.notDeepEqual(await shift(), before[1], "with Shift it moves");
  } else {
    assert.deepEqual(await rows(), before[0], "the plane does not turn");
    assert.notDeepEqual(await shift(), before[1], "a drag moves the plane");
  }
  assert.notEqual(await drawn(page), before[2], "that is seen");
  await page.value(`document.getElementById("picture").focus()`);
  const zoom = await page.value("pfaffReport.picture.camera.zoom");
  await page.press("+");
  assert.ok((await page.value("pfaffReport.picture.camera.zoom")) > zoom, "plus zooms");
  await page.press("0");
  await wait(SETTLED);
  assert.deepEqual([await rows(), await shift()], before.slice(0, 2), "0 goes back");
  if (!isSpatial) return;
  const t = await at(page);
  await page.press("ArrowLeft");
  assert.notDeepEqual(await rows(), before[0], "arrow keys turn space");
  assert.equal(await at(page), t, "and leave the time alone");
  for (const [key, towards] of [["x", 0], ["y", 1], ["z", 2]]) {
    await page.press(key);
    const sight = await page.value("pfaffReport.picture.camera.towards.map(Math.abs)");
    assert.ok(sight[towards] > 1 - 1e-12, `${key} looks along ${key}`);
    const words = await page.value(`document.getElementById("view").textContent`);
    assert.match(words, new RegExp(`along −?${key}`), "and says so");
  }
  const parallel = await drawn(page);
  await page.press("p");
  await wait(SETTLED);
  assert.equal(await page.value(`document.getElementById("perspective").getAttribute("aria-pressed")`), "true");
  assert.notEqual(await drawn(page), parallel, "perspective looks different");
  await page.press("p");
  await page.press("i");
}

/** A click on a joint chooses its reaction, and what is under the pointer has a name. */
async function clicksChoose(page) {
  await seek(page, 0);
  await page.value(`document.getElementById("picture").scrollIntoView({ block: "center" })`);
  const [x, y] = await page.value(`(() => {
    const { picture } = pfaffReport;
    const other = picture.sites.findLast((s) => s.joint.reaction && s.joint.index !== picture.selected) ?? picture.sites[0];
    return other.shown.slice(0, 2);
  })()`);
  await drag(page, [x, y], [x, y]);
  const far = await page.value(`(() => {
    const { picture } = pfaffReport;
    const [u, v] = picture.sites[picture.selected].shown;
    return Math.hypot(u - ${x}, v - ${y});
  })()`);
  assert.ok(far < 14, "the joint under the pointer is chosen");
  assert.equal(
    await page.value(`document.getElementById("joint").value`),
    String(await page.value("pfaffReport.picture.selected")),
    "its curves are shown",
  );
  assert.match(await page.value(`document.getElementById("picture").title`), /reaction/, "it has a name");
}

/** One finger turns space, two move and zoom it; in the plane one finger leaves the page to scroll. */
async function fingersTurnAndZoom(page) {
  const [left, top] = await page.value(`(() => {
    document.getElementById("picture").scrollIntoView({ block: "start" });
    const box = document.getElementById("picture").getBoundingClientRect();
    return [box.x, box.y];
  })()`);
  const touch = (type, ...points) => page.send("Input.dispatchTouchEvent", {
    type, touchPoints: points.map(([x, y], id) => ({ x: left + x, y: top + y, id })),
  });
  const state = () => page.value("({ right: pfaffReport.picture.camera.right, zoom: pfaffReport.picture.camera.zoom })");
  const isSpatial = await page.value(`document.querySelector(".spatial") !== null`);
  const before = await state();
  if (isSpatial) {
    await touch("touchStart", [120, 150]);
    await touch("touchMove", [150, 170]);
    await touch("touchMove", [180, 190]);
    await touch("touchEnd");
    assert.notDeepEqual((await state()).right, before.right, "a finger turns space");
  }
  await touch("touchStart", [120, 150], [180, 150]);
  await touch("touchMove", [105, 150], [195, 150]);
  await touch("touchMove", [90, 150], [210, 150]);
  await touch("touchEnd");
  assert.ok((await state()).zoom > 1.3 * before.zoom, "two fingers zoom");
  await page.value("pfaffReport.picture.zoomBy(0)");
}

/** Names that are shown stand apart at any time, also while the picture turns. */
async function namesStandApart(page) {
  for (const share of [0, 0.3, 0.7]) {
    await seek(page, share);
    const covered = await page.value(`(() => {
      const boxes = pfaffReport.picture.names.shown ?? [];
      const apart = (a, b) => a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
      return boxes.flatMap((a, k) => boxes.slice(0, k).filter((b) => !apart(a, b))).length;
    })()`);
    assert.equal(covered, 0, "names over names");
  }
}

/** A free motion swings until it is stopped; the loads of a self-stress cancel on every body. */
async function showsFirstOrder(page) {
  const motions = await page.value(`document.querySelectorAll("#motions button").length`);
  if (motions > 0) {
    await page.value(`document.querySelector("#motions button").click()`);
    const seen = new Set();
    for (let k = 0; k < 4; k += 1) {
      await wait(150);
      // Poses, since a bar that turns about itself looks the same.
      seen.add(await page.value("JSON.stringify(pfaffReport.data.drawing.bodies.map((_, k) => pfaffReport.picture.poses.of(k)))"));
    }
    assert.ok(seen.size > 1, "a free motion moves");
    await page.value(`document.querySelector("#motions button").click()`);
    assert.equal(await page.value("pfaffReport.picture.firstOrder"), null, "a second click stops it");
  }
  // Sums over bodies of force and moment about the origin, relative to the largest load.
  const sums = await page.value(`pfaffReport.data.stresses.map((stress) => {
    const picture = pfaffReport.picture;
    const n = pfaffReport.data.components.length;
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    pfaffReport.clock.set(pfaffReport.data.t[0]);
    const bodies = new Map();
    let largest = 0;
    stress.joints.forEach((j, k) => {
      const wrench = stress.wrenches[k];
      const site = picture.sites[j];
      const force = n === 3 ? [wrench[0], wrench[1], 0] : wrench.slice(0, 3);
      const own = n === 3 ? [0, 0, wrench[2]] : wrench.slice(3);
      const moment = cross(site.place(picture.poses, picture.instant), force).map((x, i) => x + own[i]);
      const [first, second] = site.joint.site.bodies;
      [[first, 1], [second ?? -1, -1]].forEach(([b, sign]) => {
        const sum = bodies.get(b) ?? [0, 0, 0, 0, 0, 0];
        bodies.set(b, sum.map((x, i) => x + sign * [...force, ...moment][i]));
      });
      largest = Math.max(largest, ...[...force, ...moment].map(Math.abs));
    });
    bodies.delete(-1);
    return Math.max(0, ...[...bodies.values()].flat().map(Math.abs)) / largest;
  })`);
  // Places that no body carries are rounded to 1e-5 of their way, and arms are some tenths of it.
  assert.ok(sums.every((sum) => sum < 1e-3), `loads that do not cancel: ${sums}`);
  if (sums.length === 0) return;
  const before = await drawn(page);
  await page.value(`(() => {
    const select = document.getElementById("stress");
    select.value = "0";
    select.dispatchEvent(new Event("change"));
  })()`);
  await wait(SETTLED);
  assert.notEqual(await drawn(page), before, "a self-stress is seen");
  assert.ok((await page.value(`document.querySelectorAll("#stress-loads li").length`)) > 0, "and told");
  await seek(page, 0.1);
  assert.equal(await page.value("pfaffReport.picture.firstOrder"), null, "time goes on with the run");
}

/** In a page: the colour of a pixel of a canvas, read from a copy. */
const PIXEL = `(canvas, x, y) => {
  const copy = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, x, y, 1, 1, 0, 0, 1, 1);
  return [...copy.getImageData(0, 0, 1, 1).data].join();
}`;

/** Of two bars that cross, the nearer one is seen where they do: from both sides. */
async function nearerHides(page) {
  const colour = () => page.value(`(() => {
    const { picture } = pfaffReport;
    Object.assign(picture.show, { names: false, forces: false, freedom: false, centres: false, grid: false });
    picture.sites = [];
    picture.paint(1);
    const [x, y] = picture.camera.project([0, 0, 0]).map(Math.round);
    return (${PIXEL})(picture.canvas, x, y);
  })()`);
  const fleshOf = (k) => page.value(`((k) => {
    const { brush } = pfaffReport.picture;
    brush.context.fillStyle = brush.looks.of("body b" + k, "hull", "flesh").fill;
    brush.context.fillRect(0, 0, 1, 1);
    return (${PIXEL})(brush.canvas, 0, 0);
  })(${k})`);
  const [upper, lower] = [await fleshOf(0), await fleshOf(1)];
  assert.notEqual(upper, lower, "bodies have colours");
  for (const perspective of [false, true]) {
    await page.value(`pfaffReport.picture.camera.isPerspective = ${perspective}`);
    await page.value(`pfaffReport.picture.camera.standsAt = null; pfaffReport.picture.stand("z")`);
    assert.equal(await colour(), upper, "seen from above");
    await page.value(`pfaffReport.picture.stand("z")`);
    assert.equal(await colour(), lower, "seen from below");
  }
}

/** In a page: the size of a picture, and how many pixels of another one differ from it, as a share of those that are not ground. */
const COMPARED = `async (own, other) => {
  const load = (src) => new Promise((done, failed) => {
    const image = new Image();
    image.onload = () => done(image);
    image.onerror = () => failed(new Error("not a picture: " + src.slice(0, 40)));
    image.src = src;
  });
  const images = await Promise.all([own, other].map(load));
  const [width, height] = [images[0].width, images[0].height];
  const [a, b] = images.map((image) => {
    const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    context.imageSmoothingQuality = "high";
    context.drawImage(image, 0, 0, width, height);
    return context.getImageData(0, 0, width, height).data;
  });
  let [painted, differ] = [0, 0];
  for (let k = 0; k < a.length; k += 4) {
    const far = (x, y, from) => Math.max(...[0, 1, 2, 3].map((c) => Math.abs(x[k + c] - y[from + c])));
    if (far(a, a, 0) > 0) painted += 1;
    if (far(a, b, k) > ${PIXEL_DIFFERS}) differ += 1;
  }
  return { width, height, otherWidth: images[1].width, otherHeight: images[1].height, painted, share: differ / painted };
}`;

const compared = (page, own, other) => page.value(`(${COMPARED})(${JSON.stringify(own)}, ${JSON.stringify(other)})`);

/** An empty folder among the pictures. */
function emptyFolder(name) {
  const folder = resolve(pictures, name);
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  return folder;
}

/** Clicks a button that saves a file, and takes the file: its name and bytes. */
async function saved(page, button, folder) {
  const before = new Set(readdirSync(folder));
  await page.value(`${button}.click()`);
  for (let k = 0; k < 50; k += 1) {
    await wait(100);
    const name = readdirSync(folder).find((n) => !before.has(n) && !n.endsWith(".crdownload"));
    if (name) return [name, readFileSync(join(folder, name))];
  }
  throw new Error(`${button} saves nothing`);
}

const asUrl = (type, bytes) => `data:${type};base64,${Buffer.from(bytes).toString("base64")}`;

/** Two files of what `seen` shows, or of the same as each other: their names and bytes, and how they differ from it. */
async function savedFiles(page, seen, folder, buttonOf) {
  const files = [];
  for (const [kind, type] of [["SVG", "image/svg+xml"], ["PNG", "image/png"]]) {
    const [name, bytes] = await saved(page, buttonOf(kind), folder);
    const url = asUrl(type, bytes);
    seen ??= url;
    files.push({ name, bytes, ...(await compared(page, seen, url)) });
  }
  return files;
}

/** SVG and PNG files of the picture show what the canvas shows, which is returned with the SVG. */
async function savesPicture(browser, page, folder, name, bounds = DIFFER) {
  await browser.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder });
  await page.move(2, 2);
  await page.value("Object.assign(pfaffReport.picture, { hovered: undefined }).paint()");
  const seen = await drawn(page);
  const [svg, png] = await savedFiles(page, seen, folder, (kind) => `document.getElementById("save-${kind.toLowerCase()}")`);
  const time = await page.value(`document.getElementById("now").textContent`);
  const stem = `${name}-t${time.match(/[\d.]+/)[0]}`;
  assert.deepEqual([svg.name, png.name], [`${stem}.svg`, `${stem}.png`], "names of scene and time");
  assert.deepEqual([svg.otherWidth, svg.otherHeight], [svg.width, svg.height], "the SVG is as large as the picture");
  assert.ok(png.otherWidth >= 2 * png.width && png.otherHeight >= 2 * png.height, "the PNG has twice its pixels");
  assert.ok(svg.share < bounds.svg, `${svg.share} of the SVG differ`);
  assert.ok(png.share < bounds.png, `${png.share} of the PNG differ`);
  return [seen, svg.bytes.toString()];
}

/** The bound of the comparison is exceeded where words, filled shapes or lines are lost. */
async function seesLosses(page, [seen, svg]) {
  const kinds = { words: /<text [^>]*>[^<]*<\/text>/g, shapes: /<path [^>]*fill="[#u][^>]*>/g, lines: /<path [^>]*fill="none"[^>]*>/g };
  for (const [kind, lost] of Object.entries(kinds)) {
    const { share } = await compared(page, seen, asUrl("image/svg+xml", svg.replace(lost, "")));
    assert.ok(share > DIFFER.svg, `lost ${kind} are not seen: ${share}`);
  }
}

/** What the painters use and the SVG has not is an error, and nothing is saved. */
async function refusesUnknownMembers(page, folder) {
  const before = readdirSync(folder).length;
  for (const use of ["shadowBlur = 2", "rotate(1)", "fill(new Path2D('M0 0H9'))"]) {
    await page.value(`pfaffReport.picture.names.paint = function () { "use strict"; this.picture.brush.context.${use}; }`);
    await page.value(`document.getElementById("save-svg").click()`);
    await wait(100);
    const [complaint, ...others] = page.complaints.splice(0);
    assert.match(complaint ?? "saved", /TypeError/, `${use} is refused`);
    assert.deepEqual(others, []);
  }
  await page.value("delete pfaffReport.picture.names.paint; pfaffReport.picture.paint()");
  assert.equal(readdirSync(folder).length, before, "nothing is saved");
}

/** Files of a chart: what is seen of it is in the SVG, with title, units and legend, and the PNG shows the same. */
async function savesChart(page, folder, chart, stem) {
  const buttonOf = (kind) => `[...${chart}.querySelectorAll(".save button")].find((b) => b.textContent === "${kind}")`;
  const [svg, png] = await savedFiles(page, null, folder, buttonOf);
  assert.deepEqual([svg.name, png.name], [`${stem}.svg`, `${stem}.png`], "names of scene and chart");
  assert.ok(png.otherWidth >= 2 * png.width, "the PNG has twice its pixels");
  assert.ok(png.share < DIFFER.png, `${png.share} of the PNG differ`);
  const words = await page.value(`[...${chart}.querySelectorAll(".title, .entry, .plot text")].map((e) => e.textContent)`);
  const text = svg.bytes.toString();
  for (const word of words) assert.ok(text.includes(`>${word.replaceAll("&", "&amp;").replaceAll("<", "&lt;")}<`), `the SVG lacks ${word}`);
  assert.ok(words.some((word) => /\(.+\)$/.test(word) && word !== "t (s)"), "the title has a unit");
  const curves = await page.value(`[...${chart}.querySelectorAll(".plot > path.curve")].map((e) => e.getAttribute("d"))`);
  for (const d of curves) assert.ok(text.includes(d), "the SVG lacks a curve");
  assert.ok(!/class=|var\(|url\(/.test(text), "the SVG depends on the page");
  assert.ok(text.split("<text ").slice(1).every((t) => t.includes("font-family=") && t.includes("fill=")), "text without a font or a colour");
}

/** Every chart can be saved. */
async function chartsHaveButtons(page) {
  const lacking = await page.value(`[...document.querySelectorAll(".chart")].filter((c) => c.querySelectorAll(".save button").length !== 2).length`);
  assert.equal(lacking, 0, "charts that cannot be saved");
}

/** A reader puts several curves of one unit into one plot; what the model does not determine is not offered. */
async function plotsSeveral(page) {
  const add = () => page.value(`(() => {
    const select = document.getElementById("own-curve");
    const [first] = [...select.options].filter((o) => o.value !== "");
    if (!first) return null;
    select.value = first.value;
    select.dispatchEvent(new Event("change"));
    return first.text;
  })()`);
  const shown = () => page.value(`[...document.querySelectorAll("#own-chart .chart:not([hidden]) .plot > path.curve")].length`);
  assert.equal(await shown(), 0, "no curve at first");
  const names = [await add(), await add()];
  assert.equal(await shown(), names.filter(Boolean).length, "the chosen curves are drawn");
  const title = await page.value(`document.querySelector("#own-chart .title").textContent`);
  assert.ok(title.startsWith(names.filter(Boolean).join(", ")), title);
  const empty = await page.value(`pfaffReport.charts.find((c) => c.figure.closest("#own-chart")).series.filter((s) => !s.values.some(Number.isFinite)).length`);
  assert.equal(empty, 0, "curves without values are offered");
  await page.value(`document.getElementById("own-clear").click()`);
  assert.equal(await shown(), 0, "all are removed");
}

/** Largest number of pages of a report for a customer. */
const PAPER_PAGES = 5;

const pagesOf = (pdf) => pdf.toString("latin1").match(/\/Type\s*\/Page\b(?!s)/g)?.length ?? 0;

/** A report for a customer: few pages, all curves determined, annexes only on request, and plots that stand alone. */
async function checkCustomer(browser, file) {
  const page = await opened(browser, file);
  await curvesHaveContent(page, 2);
  await chartsHaveButtons(page);
  assert.equal(await page.value(`document.querySelectorAll(".badge.not_unique, .plot > path.band").length`), 0, "only determined curves");
  assert.match(await page.value(`document.getElementById("assumptions").textContent`), /All bodies are rigid/);
  const paper = await page.paper();
  writeFileSync(join(pictures, "customer-paper.pdf"), paper);
  const count = pagesOf(paper);
  assert.ok(count > 0 && count <= PAPER_PAGES, `${count} pages`);
  await page.value(`document.querySelectorAll("details.annex").forEach((d) => { d.open = true; })`);
  assert.ok(pagesOf(await page.paper()) > count, "open annexes are printed");
  const folder = emptyFolder("customer");
  await browser.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder });
  await savesChart(page, folder, `document.querySelector("#printed-curves .chart")`, "customer-Loads-kN");
  assertQuiet(page);
  const dark = await opened(browser, file, { prefers: { "prefers-color-scheme": "dark" } });
  writeFileSync(join(pictures, "customer-dark.png"), await dark.picture());
  assertQuiet(dark);
  const phone = await opened(browser, file, { width: 390, height: 844, mobile: true });
  assert.equal(await isTooWide(phone), false, "the page fits a phone");
  assertQuiet(phone);
  for (const each of [page, dark, phone]) await browser.send("Target.closeTarget", { targetId: each.target });
}

/** A thousand bodies: the page opens at once and shows this many pictures a second by its own counter. */
async function crowdMoves(browser, file) {
  const began = Date.now();
  const page = await opened(browser, file);
  const loaded = Date.now() - began - SETTLED;
  const count = await page.value("pfaffReport.data.drawing.bodies.length");
  assert.ok(count >= 1000, `${count} bodies`);
  await page.value("pfaffReport.clock.play()");
  await wait(4000);
  const rate = await page.value("pfaffReport.clock.picturesPerSecond");
  assert.ok(loaded < CROWD_LOAD, `${loaded} ms until it is shown`);
  assert.ok(rate >= CROWD_RATE, `${rate.toFixed(1)} pictures a second`);
  await page.value("pfaffReport.clock.pause()");
  await wait(SETTLED);
  await savesPicture(browser, page, emptyFolder("crowd"), "crowd", CROWD_DIFFERS);
  assertQuiet(page);
  await browser.send("Target.closeTarget", { targetId: page.target });
  return `${count} bodies, shown after ${loaded} ms, ${rate.toFixed(1)} pictures a second`;
}

/** Whether parts of the page stand over its edge. */
const isTooWide = (page) => page.value("document.documentElement.scrollWidth > document.documentElement.clientWidth");

async function check(browser, name, file) {
  const save = (kind, bytes) => writeFileSync(join(pictures, `${name}-${kind}`), bytes);

  const light = await opened(browser, file);
  await movesAndScrubs(light);
  await curvesHaveContent(light);
  await axesEndAtRounding(light);
  await noBareLines(light);
  await chartsHaveButtons(light);
  await plotsSeveral(light);
  await turnsAndZooms(light);
  await clicksChoose(light);
  await namesStandApart(light);
  await showsFirstOrder(light);
  await tipsTellValues(light);
  await seek(light, 0.35);
  assert.equal(await isTooWide(light), false, "the page fits its window");
  save("light.png", await light.picture());
  await seesLosses(light, await savesPicture(browser, light, emptyFolder(`${name}-light`), name));
  const background = (page) => page.value("getComputedStyle(document.body).backgroundColor");
  const bright = await background(light);
  await light.value(`document.getElementById("theme").click()`);
  assert.notEqual(await background(light), bright, "the button changes the colours");
  const paper = await light.paper();
  assert.ok(paper.subarray(0, 5).toString() === "%PDF-" && paper.length > 20_000, "a PDF");
  save("paper.pdf", paper);
  assertQuiet(light);

  const dark = await opened(browser, file, { prefers: { "prefers-color-scheme": "dark" } });
  assert.notEqual(await background(dark), bright, "the system's dark colours");
  await seek(dark, 0.35);
  save("dark.png", await dark.picture());
  const files = emptyFolder(`${name}-dark`);
  await savesPicture(browser, dark, files, name);
  await savesChart(dark, files, `document.querySelector("#energy-curves .chart")`, `${name}-Energy-J`);
  await refusesUnknownMembers(dark, files);
  assertQuiet(dark);

  const phone = await opened(browser, file, { width: 390, height: 844, mobile: true });
  await phone.value(`document.getElementById("motion").scrollIntoView()`);
  await seek(phone, 0.35);
  assert.equal(await isTooWide(phone), false, "the page fits a phone");
  const cut = await phone.value(`[...document.querySelectorAll(".wide")].filter((e) => e.scrollWidth > e.clientWidth + 1).length`);
  assert.equal(cut, 0, "no column is cut off");
  await fingersTurnAndZoom(phone);
  await phone.value(`document.getElementById("motion").scrollIntoView()`);
  save("phone.png", await phone.picture());
  assertQuiet(phone);

  const lively = await opened(browser, file, { prefers: { "prefers-reduced-motion": "no-preference" } });
  assert.equal(await lively.value("pfaffReport.clock.playing"), true, "plays by itself");
  assertQuiet(lively);
  for (const page of [light, dark, phone, lively]) await browser.send("Target.closeTarget", { targetId: page.target });
}

if (!program || !pictures || reports.length === 0) {
  console.error("usage: node tests/browser/report.mjs CHROMIUM PICTURES NAME=report.html ...");
  process.exit(2);
}
mkdirSync(pictures, { recursive: true });
let failed = false;

/** Looks at one report and says what was found. */
async function look(browser, name, file) {
  try {
    if (name === "crowd") {
      console.log(`${name}: ${await crowdMoves(browser, file)}`);
      return;
    }
    if (name === "customer") {
      await checkCustomer(browser, file);
      console.log(`${name}: right`);
      return;
    }
    await check(browser, name, file);
    if (name === "crossing") {
      const page = await opened(browser, file);
      await nearerHides(page);
      assertQuiet(page);
    }
    console.log(`${name}: right`);
  } catch (error) {
    failed = true;
    console.error(`${name}: ${error.message}`);
  }
}

/** Each browser takes the next report: most of the time they wait for pages to settle. */
async function lookAt(reports, browsers) {
  const left = [...reports];
  const worker = async () => {
    const browser = new Browser(program);
    for (let next = left.shift(); next; next = left.shift()) await look(browser, ...next.split("="));
    await browser.close();
  };
  await Promise.all(Array.from({ length: browsers }, worker));
}

// The rate of a crowd is that of a machine on which nothing else runs.
const isCrowd = (report) => report.startsWith("crowd=");
await lookAt(reports.filter((report) => !isCrowd(report)), BROWSERS);
await lookAt(reports.filter(isCrowd), 1);
process.exit(failed ? 1 : 0);
