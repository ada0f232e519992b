// Drags a body in the picture.

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
export async function drag({ page }, index) {
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
