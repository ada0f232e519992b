// Faults that a foreign examiner found.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Visit } from "../browser.mjs";

async function on({ address }, act) {
  const visit = await Visit.begin(address);
  try {
    await act(visit);
    assert.deepEqual(visit.errors, []);
  } finally {
    await visit.end();
  }
}

/** Keeps a scene as an earlier visit of the page does, and opens the page. */
async function withStored(visit, scene) {
  await visit.page.addInitScript((own) => localStorage.setItem("pfaff-scene", own), JSON.stringify(scene));
  return visit.open();
}

/** The memory of a new instance grows with its first request. */
export const largeFirstScene = (server) => on(server, async (visit) => {
  const page = await visit.example("door");
  const text = `${await visit.text()}${"# a long comment\n".repeat(3000)}`;
  await page.goto("about:blank");
  await withStored(visit, { name: "door", text });
  await visit.settled();
});

export const linesOfWindows = (server) => on(server, async (visit) => {
  const page = await visit.example("door");
  const text = (await visit.text()).replace('"lower", type = "revolute"', '"lower", type = "revolut"');
  const file = join(mkdtempSync(join(tmpdir(), "pfaff-")), "door.toml");
  writeFileSync(file, text.replaceAll("\n", "\r\n"));
  await page.locator("#file").setInputFiles(file);
  await page.getByRole("button", { name: "Replace with revolute" }).click();
  await visit.settled();
  assert.equal(await visit.text(), text.replace('"revolut"', '"revolute"'));
});

/** A problem that only the analysis finds stays on the page. */
export const problemsOfTheAnalysis = (server) => on(server, async (visit) => {
  const page = await visit.example("four-bar");
  const text = await visit.text();
  const drive = text.match(/\[\[drive\]\][\s\S]*?(?=\n\n|$)/)?.[0] ?? text.match(/\{ name = "motor"[^\n]*\}/)[0];
  await visit.write(text.replace(drive, drive.replace(/rate = [^,}\n]*/, "rate = 1e60")));
  await page.locator("#state", { hasText: "Not analysed" }).waitFor();
  await page.waitForTimeout(1500);
  assert.ok(await page.locator("#problems li").count() || await page.locator("#message:visible").count());
  await page.locator("#start.stale").waitFor();
});

export const namesInCommands = (server) => on(server, async (visit) => {
  const page = await withStored(visit, { name: "x; touch y #\n\")", text: (await (await visit.example("door"), visit.text())) });
  const name = await page.locator("#name").inputValue();
  assert.match(name, /^[\p{L}\p{N}_][\p{L}\p{N}_.-]*$/u);
});

/** A short address can unpack to much more, and a line can be long. */
export const longLines = (server) => on(server, async (visit) => {
  const text = `a = [${'"a",'.repeat(50_000)}]`;
  const { page, address } = visit;
  await page.addInitScript((own) => localStorage.setItem("pfaff-scene", own), JSON.stringify({ name: "long", text }));
  const begun = performance.now();
  await page.goto(address);
  await page.locator("#problems li").first().waitFor();
  assert.ok(performance.now() - begun < 10_000);
});

/** An edited scene comes back. */
export const backToAnEditedScene = (server) => on(server, async (visit) => {
  const page = await visit.example("door");
  const edited = `${await visit.text()}# mine\n`;
  await visit.write(edited);
  await visit.settled();
  await page.getByRole("button", { name: "Examples" }).click();
  await page.locator("#cards button", { hasText: "carriage" }).first().click();
  await visit.settled();
  assert.equal(await page.evaluate(() => location.hash), "");
  await page.getByRole("button", { name: "Back to door" }).click();
  await visit.settled();
  assert.equal(await visit.text(), edited);
});
