// Opens reports in headless Chromium and looks whether they live: no errors, a picture that moves, curves with content, a dark page,
// a phone, and paper. Run by `cargo xtask browser`, or as
//   node tests/browser/report.mjs CHROMIUM PICTURES NAME=report.html ...

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { mkdirSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { Browser } from "./devtools.mjs";

const [program, pictures, ...reports] = process.argv.slice(2);

/** Time for scripts and layout (ms). */
const SETTLED = 400;

const wait = (ms) => new Promise((done) => {
  setTimeout(done, ms);
});

const hash = (bytes) => createHash("sha256").update(bytes).digest("hex");

/** Opens a report as a reader with these preferences and this window sees it. */
async function opened(browser, file, { width = 1400, height = 1050, mobile = false, prefers = {} } = {}) {
  const page = await browser.page(width, height);
  if (mobile) await page.resize(width, height, true);
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

async function curvesHaveContent(page) {
  const charts = await page.value(`[...document.querySelectorAll(".chart:not([hidden])")].map((chart) => ({
    title: chart.querySelector(".title").textContent,
    curves: [...chart.querySelectorAll(".plot > path.curve")].map((p) => p.getAttribute("d").length),
    labels: [...chart.querySelectorAll(".axes text")].map((t) => t.textContent),
    words: chart.querySelector(".plot").getAttribute("aria-label"),
    bands: chart.querySelectorAll(".plot > path.band").length,
    open: chart.querySelector(".badge.not_unique") !== null,
  }))`);
  assert.ok(charts.length >= 5, `${charts.length} charts`);
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

/** Whether parts of the page stand over its edge. */
const isTooWide = (page) => page.value("document.documentElement.scrollWidth > document.documentElement.clientWidth");

async function check(browser, name, file) {
  const save = (kind, bytes) => writeFileSync(join(pictures, `${name}-${kind}`), bytes);

  const light = await opened(browser, file);
  await movesAndScrubs(light);
  await curvesHaveContent(light);
  await noBareLines(light);
  await tipsTellValues(light);
  await seek(light, 0.35);
  assert.equal(await isTooWide(light), false, "the page fits its window");
  save("light.png", await light.picture());
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
  assertQuiet(dark);

  const phone = await opened(browser, file, { width: 390, height: 844, mobile: true });
  await phone.value(`document.getElementById("motion").scrollIntoView()`);
  await seek(phone, 0.35);
  assert.equal(await isTooWide(phone), false, "the page fits a phone");
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
const browser = new Browser(program);
let failed = false;
for (const report of reports) {
  const [name, file] = report.split("=");
  try {
    await check(browser, name, file);
    console.log(`${name}: right`);
  } catch (error) {
    failed = true;
    console.error(`${name}: ${error.message}`);
  }
}
await browser.close();
process.exit(failed ? 1 : 0);
