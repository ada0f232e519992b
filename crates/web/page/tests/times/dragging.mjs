// Times of the steps of a drag.

import assert from "node:assert/strict";
import { Visit } from "../browser.mjs";
import { drag } from "../drag.mjs";

/** Largest times of 95 % of the steps (ms): of planar examples with few rows, and of the others. */
const PLANAR_MOST = 100;
const MOST = 300;
const PLANAR_ROWS = 40;
const share = (times, p) => times.sort((a, b) => a - b)[Math.min(Math.floor(p * times.length), times.length - 1)];

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
