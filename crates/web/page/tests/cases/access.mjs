// Findings of axe, and use by keyboard.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { Visit } from "../browser.mjs";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

async function findings(page) {
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => globalThis.axe.run({ exclude: [["iframe"]] }));
  return violations.map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(" | ")}`);
}

async function clean({ address }, options) {
  const visit = await Visit.begin(address, options);
  try {
    const page = await visit.example("door");
    const found = [];
    const check = async (what) => found.push(...(await findings(page)).map((own) => `${what}: ${own}`));
    await page.getByRole("button", { name: "Why: lower" }).click();
    await check("verdicts");
    if (await page.locator("#compare").isVisible()) await page.locator("#compare").click();
    for (const tab of await page.getByRole("tab").all()) {
      await tab.click();
      await check(await tab.innerText());
    }
    await page.getByRole("button", { name: "Examples" }).click();
    await page.locator("#cards img").first().waitFor();
    await check("gallery");
    await page.keyboard.press("Escape");
    if (await page.getByRole("tab", { name: "Scene" }).isVisible()) await page.getByRole("tab", { name: "Scene" }).click();
    await visit.write((await visit.text()).replace('"revolute"', '"revolut"'));
    await page.locator("#problems li").first().waitFor();
    await check("problems");
    assert.deepEqual(found, []);
  } finally {
    await visit.end();
  }
}

export const light = (server) => clean(server, { colorScheme: "light" });
export const dark = (server) => clean(server, { colorScheme: "dark" });
export const narrow = (server) => clean(server, { viewport: { width: 390, height: 780 } });

export const embedded = async ({ address }) => {
  const visit = await Visit.begin(address, { viewport: { width: 640, height: 520 } });
  try {
    const page = await visit.open("?embed#example=truss");
    assert.deepEqual(await findings(page), []);
  } finally {
    await visit.end();
  }
};

export const keyboard = async ({ address }) => {
  const visit = await Visit.begin(address);
  try {
    const page = await visit.example("door");
    await page.getByRole("tab", { name: "Verdicts" }).focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("#words").isVisible(), true);
    await page.locator("#editor .cm-content").focus();
    // Escape, then the tabulator, leaves the editor.
    await page.keyboard.press("Escape");
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.closest(".cm-editor") === null), true);
  } finally {
    await visit.end();
  }
};
