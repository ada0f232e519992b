// The editor: problems, completion, hover, selection, design changes.

import assert from "node:assert/strict";
import { Visit } from "../browser.mjs";

async function on({ address }, name, act) {
  const visit = await Visit.begin(address);
  try {
    const page = await visit.example(name);
    await act(visit, page);
    assert.deepEqual(visit.errors, []);
    assert.deepEqual(visit.foreign, []);
  } finally {
    await visit.end();
  }
}

const marked = (page) => page.evaluate(() => {
  const ranges = [...document.querySelectorAll("#editor .cm-lintRange-error")];
  return ranges.map((range) => range.textContent).join("");
});

export const markAfterEmoji = (server) => on(server, "door", async (visit, page) => {
  const text = await visit.text();
  await visit.write(text.replace("# A door", "# µ 😀😀 φ").replace('"lower", type = "revolute"', '"lower", type = "revolut"'));
  await page.waitForSelector("#editor .cm-lintRange-error");
  assert.equal(await marked(page), '"revolut"');
  await page.getByRole("button", { name: "Replace with revolute" }).click();
  await page.waitForSelector("#editor .cm-lintRange-error", { state: "detached" });
  assert.match(await visit.text(), /"lower", type = "revolute"/);
  await visit.settled();
});

export const completion = (server) => on(server, "door", async (visit, page) => {
  const text = await visit.text();
  await visit.write(`${text}\n[[`);
  await page.keyboard.type("mar");
  const option = page.locator(".cm-tooltip-autocomplete li", { hasText: "marker" });
  await option.waitFor();
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText(text.replace('type = "revolute", bodies = ["ground", "leaf"], at = [0.0, 1.75]', ""));
  await page.waitForTimeout(200);
});

export const hover = (server) => on(server, "door", async (_, page) => {
  await page.locator("#editor .tok-propertyName", { hasText: "gravity" }).hover();
  await page.locator(".cm-tooltip-hover .hover").waitFor();
});

export const rowSelectsLine = (server) => on(server, "door", async (_, page) => {
  await page.locator(".verdicts th .link", { hasText: "upper" }).click();
  await page.waitForFunction(() => document.querySelector("#editor .cm-activeLine").textContent.includes('"upper"'));
  const selected = await page.evaluate(() => {
    const { picture, data } = document.getElementById("start").contentWindow.pfaffReport;
    return data.joints[picture.selected].name;
  });
  assert.equal(selected, "upper");
});

export const lineSelectsRow = (server) => on(server, "door", async (_, page) => {
  await page.locator("#editor .cm-line", { hasText: '"lower"' }).click();
  await page.locator(".verdicts tr[data-selected]", { hasText: "lower" }).waitFor();
});

export const jointInPictureSelectsRow = (server) => on(server, "door", async (_, page) => {
  const at = await page.evaluate(() => {
    const { picture } = document.getElementById("start").contentWindow.pfaffReport;
    return picture.sites[1].shown.slice(0, 2);
  });
  await page.locator("#start").contentFrame().locator("#picture").click({ position: { x: at[0], y: at[1] } });
  await page.locator(".verdicts tr[data-selected]", { hasText: "upper" }).waitFor();
});

export const designChangeAndUndo = (server) => on(server, "door", async (visit, page) => {
  const before = await visit.text();
  await page.getByRole("button", { name: /Replace in place/ }).click();
  await page.waitForFunction(() => !document.querySelector(".verdicts .not_unique"));
  assert.match(await visit.text(), /pin-in-slot/);
  await page.getByRole("button", { name: "Undo" }).click();
  await page.waitForSelector(".verdicts .not_unique");
  assert.equal(await visit.text(), before);
});

export const whyAndBounds = (server) => on(server, "door", async (_, page) => {
  await page.getByRole("button", { name: "Why: lower" }).click();
  await page.locator(".why", { hasText: "only Fx is determined" }).waitFor();
  await page.getByLabel("Bounds for any stiffness").check();
  await page.locator(".why .number", { hasText: "−196.2 … 0" }).waitFor();
});

export const greyWhileStale = (server) => on(server, "door", async (visit, page) => {
  await visit.write(`${(await visit.text()).trim()} # x`);
  await page.waitForSelector("#reactions.stale");
  await visit.settled();
});
