// Bodies that the user drags.

import assert from "node:assert/strict";
import { Visit } from "../browser.mjs";

/** Largest times of 95 % of the steps (ms): of planar examples with few rows, and of the others. */
const PLANAR_MOST = 100;
const MOST = 300;
const PLANAR_ROWS = 40;
/** Steps of the pointer. */
const STEPS = 25;

/** Returns a place of the page on a body, far from symbols of joints, and listens to the steps. */
const prepare = (page, index) => page.evaluate((body) => {
  const frame = document.getElementById("start");
  const { picture, data } = frame.contentWindow.pfaffReport;
  const pose = picture.poses.of(body);
  const places = data.drawing.bodies[body].outline.map((p) => {
    const [u, v, w = 0] = p.map((x) => 0.4 * x);
    const turned = pose.rows.map((row) => row[0] * u + row[1] * v + row[2] * w);
    return picture.camera.project(pose.r.map((r, k) => r + turned[k]));
  });
  const nearest = ([a, b]) => Math.min(...picture.sites.map(({ shown }) => Math.hypot(shown[0] - a, shown[1] - b)));
  const [x, y] = places.sort((a, b) => nearest(b) - nearest(a))[0];
  globalThis.steps = [];
  if (!frame.contentDocument.isWatched) {
    frame.contentDocument.isWatched = true;
    let asked;
    frame.contentDocument.addEventListener("pfaff:drag", () => { asked ??= performance.now(); });
    frame.contentDocument.addEventListener("pfaff:start", () => requestAnimationFrame(() => {
      if (asked) globalThis.steps.push(performance.now() - asked);
      asked = undefined;
    }));
  }
  const box = frame.getBoundingClientRect();
  return [x + box.left, y + box.top];
}, index);

/** Drags a body along a loop, and returns the times of the steps (ms). */
async function drag({ page }, index) {
  const [x, y] = await prepare(page, index);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let k = 1; k <= STEPS; k += 1) {
    const angle = (k / STEPS) * Math.PI;
    await page.mouse.move(x + 50 * Math.sin(angle), y - 20 * Math.sin(2 * angle));
    await page.waitForTimeout(16);
  }
  await page.mouse.up();
  await page.waitForTimeout(300);
  return page.evaluate(() => globalThis.steps);
}

const share = (times, p) => times.sort((a, b) => a - b)[Math.min(Math.floor(p * times.length), times.length - 1)];

export const oneStepOfTheHistory = async ({ address }) => {
  const visit = await Visit.begin(address);
  try {
    const page = await visit.example("three-cranks");
    const before = await visit.text();
    const times = await drag(visit, 3);
    assert.notEqual(await visit.text(), before, "the text has not changed");
    assert.ok(times.length > 5, `${times.length} steps`);
    await visit.settled();
    await page.locator("#editor .cm-content").focus();
    await page.keyboard.press("Control+z");
    assert.equal(await visit.text(), before, "one step back is the text before the drag");
    assert.deepEqual(visit.errors, []);
  } finally {
    await visit.end();
  }
};

/** Drags a body of each example that moves. */
export const everyExample = async ({ address }) => {
  const visit = await Visit.begin(address);
  const seen = [];
  try {
    const page = await visit.open();
    const examples = await page.evaluate(() => fetch("examples.json").then((reply) => reply.json()));
    for (const { name, text } of examples) {
      await page.goto("about:blank");
      await visit.example(name);
      const facts = await page.evaluate(() => Object.fromEntries([...document.querySelectorAll(".tiles div")]
        .map((own) => [own.querySelector("dt").textContent, own.querySelector("dd").textContent])));
      const bodies = await page.evaluate(() => document.getElementById("start").contentWindow.pfaffReport.data.drawing.bodies.length);
      let times = [];
      for (let body = bodies - 1; body >= 0 && Number(facts.mobility) > 0; body -= 1) {
        times = await drag(visit, body);
        if (await visit.text() !== text) break;
        times = [];
      }
      if (!times.length) continue;
      const isPlanar = await page.evaluate(() => !document.getElementById("start").contentWindow.pfaffReport.data.drawing.view);
      const rows = Number(facts["independent rows"].split(" of ")[1]);
      seen.push({ name, times, most: isPlanar && rows <= PLANAR_ROWS ? PLANAR_MOST : MOST });
    }
    const remarks = [PLANAR_MOST, MOST].map((most) => {
      const own = seen.filter((example) => example.most === most);
      const slow = share(own.flatMap(({ times }) => times), 0.95);
      const slowest = own.map(({ name, times }) => [share(times, 0.95), name]).sort(([a], [b]) => b - a)[0];
      assert.ok(slow <= most, `95 % of the steps take up to ${slow} ms, limit ${most} ms; slowest: ${slowest}`);
      return `${own.length} examples: 95 % ${slow.toFixed(0)} ms (${slowest[1]} ${slowest[0].toFixed(0)} ms)`;
    });
    assert.deepEqual(visit.errors, []);
    return remarks.join("; ");
  } finally {
    await visit.end();
  }
};

/** Joints that hold a body prevent a drag, and the text stays. */
export const lockedBody = async ({ address }) => {
  const visit = await Visit.begin(address);
  try {
    const page = await visit.example("door");
    const before = await visit.text();
    await drag(visit, 0);
    await page.locator("#message", { hasText: "prevent a motion" }).waitFor();
    assert.equal(await visit.text(), before);
  } finally {
    await visit.end();
  }
};
