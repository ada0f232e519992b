// Bodies that the user drags.

import assert from "node:assert/strict";
import { Visit } from "../browser.mjs";
import { drag } from "../drag.mjs";

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
