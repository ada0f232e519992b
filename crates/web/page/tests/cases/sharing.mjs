// Addresses, files, storage, embedding, use without a network.

import assert from "node:assert/strict";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Visit } from "../browser.mjs";

const URDF = `<robot name="arm">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0 0 0.5"/><mass value="2"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
</robot>`;

async function on({ address }, act, options) {
  const visit = await Visit.begin(address, options);
  try {
    return await act(visit);
  } finally {
    await visit.end();
  }
}

export const address = (server) => on(server, async (visit) => {
  const page = await visit.example("carriage");
  const text = `${await visit.text()}# µ 😀\n`;
  await visit.write(text);
  await visit.settled();
  await page.getByRole("button", { name: "Share" }).click();
  await page.waitForFunction(() => location.hash.startsWith("#1="));
  const shared = await page.evaluate(() => location.hash);
  await page.evaluate(() => localStorage.clear());
  const other = await visit.context.newPage();
  await other.goto(`${server.address}${shared}`);
  await other.getByRole("button", { name: "Analyse it" }).waitFor();
  await other.locator("#editor .cm-content").waitFor();
  assert.equal(await other.locator(".verdicts").count(), 0, "the scene was analysed before the click");
  await other.getByRole("button", { name: "Analyse it" }).click();
  await other.waitForSelector(".verdicts");
  assert.equal(await other.locator("#name").inputValue(), "carriage");
  assert.equal(await other.evaluate(() => location.hash), "", "a reload shows the stored scene");
  return `${shared.length} characters`;
});

export const damagedAddress = (server) => on(server, async (visit) => {
  const page = await visit.open("#1=abc");
  await page.locator("#message", { hasText: "damaged" }).waitFor();
});

export const longSceneHasNoAddress = (server) => on(server, async (visit) => {
  const page = await visit.example("door");
  const noise = Array.from({ length: 9000 }, () => Math.random().toString(36)[2] ?? "x").join("");
  await visit.write(`${await visit.text()}# ${noise}\n`);
  await page.getByRole("button", { name: "Share" }).click();
  await page.locator("#message", { hasText: "too long" }).waitFor();
});

export const robotModel = (server) => on(server, async (visit) => {
  const page = await visit.open();
  const file = join(mkdtempSync(join(tmpdir(), "pfaff-urdf-")), "arm.urdf");
  writeFileSync(file, URDF);
  await page.locator("#file").setInputFiles(file);
  await page.locator("#message", { hasText: "Imported from" }).waitFor();
  await page.locator(".verdicts", { hasText: "shoulder" }).waitFor();
  assert.equal(await page.locator("#name").inputValue(), "arm");
  return (await page.locator("#message").innerText()).split("\n")[0];
});

export const droppedFile = (server) => on(server, async (visit) => {
  const page = await visit.open();
  await page.evaluate((text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "arm.urdf"));
    document.querySelector("#editor .cm-content").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, URDF);
  await page.locator(".verdicts", { hasText: "shoulder" }).waitFor();
  assert.match(await visit.text(), /^# Imported from arm\.urdf/);
  assert.doesNotMatch(await visit.text(), /<robot/);
});

export const storedScene = (server) => on(server, async (visit) => {
  const page = await visit.example("door");
  await visit.write((await visit.text()).replaceAll("upper", "top"));
  await visit.settled();
  await page.goto("about:blank");
  await visit.open();
  await page.locator(".verdicts", { hasText: "top" }).waitFor();
});

export const gallery = (server) => on(server, async (visit) => {
  const page = await visit.open();
  await page.getByRole("button", { name: "Examples" }).click();
  await page.locator("#cards img").first().waitFor();
  await page.getByLabel("Search examples").fill("scissor");
  await page.locator("#cards button:visible").click();
  await page.locator(".verdicts", { hasText: "lift" }).or(page.locator("#name")).first().waitFor();
  assert.equal(await page.locator("#name").inputValue(), "scissor-lift");
  await visit.settled();
});

export const copies = (server) => on(server, async (visit) => {
  const page = await visit.example("door");
  const clipboard = () => page.evaluate(() => navigator.clipboard.readText());
  await page.getByRole("button", { name: "Command" }).click();
  await page.locator("#message", { hasText: "Command copied" }).waitFor();
  assert.equal(await clipboard(), "pfaff analyze door.toml");
  await page.getByRole("button", { name: "Python" }).click();
  await page.locator("#message", { hasText: "Python copied" }).waitFor();
  assert.match(await clipboard(), /pfaff\.Scene\.from_file\("door\.toml"\)\.analyze\(\)/);
});

export const embedded = (server) => on(server, async (visit) => {
  const page = await visit.open("?embed#example=four-bar");
  await page.waitForFunction(() => document.getElementById("start").contentWindow?.pfaffReport);
  assert.deepEqual(await page.getByRole("tab").allInnerTexts(), ["Scene", "Verdicts", "Text"]);
  assert.equal(await page.locator(".tools").isVisible(), false);
  await page.waitForFunction(() => document.getElementById("full").href.includes("#1="));
});

export const withoutNetwork = (server) => on(server, async (visit) => {
  const page = await visit.open();
  await page.evaluate(() => navigator.serviceWorker.ready);
  await page.waitForFunction(() => navigator.serviceWorker.controller);
  await visit.context.setOffline(true);
  await page.reload();
  await page.waitForSelector(".verdicts");
  await page.getByRole("button", { name: "Examples" }).click();
  await page.locator("#cards img").first().waitFor();
});
