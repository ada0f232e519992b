// The content security policy: no foreign script runs, and no request leaves the origin.

import assert from "node:assert/strict";
import { Visit } from "../browser.mjs";

export const scriptsAndRequests = async ({ address }) => {
  const visit = await Visit.begin(address);
  try {
    const page = await visit.open();
    const found = await page.evaluate(async () => {
      const frame = document.createElement("iframe");
      frame.srcdoc = "<script>parent.hasRun = true</script>";
      document.body.append(frame);
      await new Promise((resolve) => { frame.onload = resolve; });
      const sent = await fetch("https://example.org/").then(() => true, () => false);
      return { hasRun: globalThis.hasRun === true, sent };
    });
    assert.deepEqual(found, { hasRun: false, sent: false });
  } finally {
    await visit.end();
  }
};
