// Runs: rows, report, stop, failures of the module.

import assert from "node:assert/strict";
import { Visit } from "../browser.mjs";

async function on({ address }, name, act) {
  const visit = await Visit.begin(address);
  try {
    const page = await visit.example(name);
    return await act(visit, page);
  } finally {
    await visit.end();
  }
}

export const simulate = (server) => on(server, "four-bar", async (visit, page) => {
  await page.getByRole("tab", { name: "Motion" }).click();
  await page.getByRole("button", { name: "Simulate" }).click();
  await page.locator("#run-state", { hasText: "Done" }).waitFor();
  const report = page.locator("#report").contentFrame();
  await report.locator("#scrub").waitFor();
  await page.waitForFunction(() => document.getElementById("report").contentWindow.pfaffReport.clock.t > 0);
  await page.getByRole("tab", { name: "Files" }).click();
  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name: "Download trajectory.csv" }).click();
  const { createReadStream } = await import("node:fs");
  let text = "";
  for await (const part of createReadStream(await (await waiting).path())) text += part;
  const rows = await page.locator("tr", { hasText: "trajectory.csv" }).locator("td").first().textContent();
  assert.equal(text.trim().split("\n").length - 1, Number(rows));
  assert.ok(Number(rows) > 10);
  assert.deepEqual(visit.errors, []);
  assert.deepEqual(visit.foreign, []);
  return `${rows} rows`;
});

export const stopKeepsRows = (server) => on(server, "robot-trolley", async (visit, page) => {
  await visit.write((await visit.text()).replace(/t_end = [\d.]+/, "t_end = 100000.0"));
  await visit.settled();
  await page.getByRole("tab", { name: "Motion" }).click();
  await page.getByRole("button", { name: "Simulate" }).click();
  await page.locator("#run-state", { hasText: /\d{2,} rows/ }).waitFor();
  await page.locator("#stop-run").click();
  await page.locator("#run-state", { hasText: /Stopped\. The tab Files has \d+ rows/ }).waitFor();
  await page.getByRole("tab", { name: "Files" }).click();
  const rows = Number(await page.locator("tr", { hasText: "trajectory.csv" }).locator("td").first().textContent());
  assert.ok(rows > 10);
  return `${rows} rows`;
});

export const failureOfTheModule = (server) => on(server, "door", async (visit, page) => {
  const text = await visit.text();
  // The next request traps in the worker.
  for (const worker of page.workers()) {
    await worker.evaluate(() => {
      TextEncoder.prototype.encode = () => { throw new WebAssembly.RuntimeError("unreachable"); };
    });
  }
  await visit.write(`${text}# changed\n`);
  await page.locator("#message", { hasText: "made a new instance" }).waitFor();
  await page.locator("#message pre", { hasText: "unreachable" }).waitFor();
  await visit.write(text.replace("20.0", "21.0"));
  await visit.settled();
  assert.match(await visit.text(), /21\.0/);
});

export const stopAnalysis = (server) => on(server, "door", async (visit, page) => {
  const text = await visit.text();
  // The worker does not finish the next request.
  for (const worker of page.workers()) {
    await worker.evaluate(() => {
      JSON.stringify = () => { for (;;); };
    });
  }
  await visit.write(text.replace("20.0", "21.0"));
  await page.locator("#stop-analysis").click();
  await visit.write(text.replace("20.0", "22.0"));
  await visit.settled();
});

export const otherQuestion = (server) => on(server, "three-cranks", async (_, page) => {
  await page.getByRole("tab", { name: "More" }).click();
  await page.locator("#question").selectOption("equilibrium");
  await page.locator("#ask").click();
  await page.locator("#answer", { hasText: "equilibrium found" }).waitFor();
});

export const compare = (server) => on(server, "door", async (_, page) => {
  await page.getByRole("button", { name: "Compare", exact: true }).click();
  await page.locator("#second .cm-content").waitFor();
  const status = await page.locator("#status").boundingBox();
  assert.ok(status.y + status.height <= page.viewportSize().height, "the editors leave room");
  await page.getByRole("tab", { name: "Verdicts" }).click();
  await page.getByRole("button", { name: /Replace in place/ }).click();
  await page.getByRole("tab", { name: "Difference" }).click();
  await page.getByRole("button", { name: "Compare scenes" }).click();
  await page.locator("#difference-words", { hasText: "pin-in-slot" }).waitFor();
});
