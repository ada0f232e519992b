// The time until the first verdict, with an empty profile.

import assert from "node:assert/strict";
import { Visit } from "../browser.mjs";

/**
 * Returns the median time until the first verdict (ms). Chromium slows the thread of the page, but
 * not its workers.
 */
async function firstVerdict(address, count, slower) {
  const times = [];
  for (let k = 0; k < count; k += 1) {
    const visit = await Visit.begin(address);
    try {
      if (slower > 1) {
        const session = await visit.context.newCDPSession(visit.page);
        await session.send("Emulation.setCPUThrottlingRate", { rate: slower });
      }
      await visit.open();
      times.push(await visit.page.evaluate(() => performance.getEntriesByName("pfaff-verdict")[0].startTime));
      assert.deepEqual(visit.foreign, []);
    } finally {
      await visit.end();
    }
  }
  return times.sort((a, b) => a - b)[times.length >> 1];
}

async function within({ address }, slower, most) {
  const median = await firstVerdict(address, 10, slower);
  assert.ok(median <= most, `median ${median} ms`);
  return `median of 10: ${Math.round(median)} ms`;
}

export const coldLoad = (server) => within(server, 1, 1000);
export const coldLoadThrottled = (server) => within(server, 4, 3000);
