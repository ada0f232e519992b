// Chromium with an empty profile, and the page in it.

import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const ARGUMENTS = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];

/** Errors of the console that a test does not expect, and requests to other origins. */
export class Visit {
  /** Opens a browser with an empty profile. */
  static async begin(address, options = {}) {
    const profile = mkdtempSync(join(tmpdir(), "pfaff-profile-"));
    const context = await chromium.launchPersistentContext(profile, {
      executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ARGUMENTS, acceptDownloads: true,
      viewport: { width: 1360, height: 860 }, permissions: ["clipboard-read", "clipboard-write"], ...options,
    });
    const visit = Object.assign(new Visit(), { profile, context, address, foreign: [], errors: [] });
    context.on("request", (request) => {
      const url = new URL(request.url());
      const isOwn = ["data:", "blob:", "about:"].includes(url.protocol) || url.origin === new URL(address).origin;
      if (!isOwn) visit.foreign.push(request.url());
    });
    visit.page = context.pages()[0] ?? await context.newPage();
    visit.page.on("console", (message) => message.type() === "error" && visit.errors.push(message.text()));
    visit.page.on("pageerror", (error) => visit.errors.push(String(error)));
    visit.page.setDefaultTimeout(20_000);
    return visit;
  }

  async end() {
    await this.context.close();
    rmSync(this.profile, { recursive: true, force: true });
  }

  /** Opens the page, and waits for verdicts. */
  async open(suffix = "", wanted = ".verdicts") {
    await this.page.goto(`${this.address}${suffix}`);
    await this.page.waitForSelector(wanted);
    if (!suffix.includes("embed")) await this.page.waitForSelector("#editor .cm-content", { state: "attached" });
    return this.page;
  }

  /** Opens an example. */
  async example(name) {
    const page = await this.open(`#example=${name}`);
    await this.settled();
    return page;
  }

  /** Waits until all answers belong to the text. */
  async settled() {
    await this.page.waitForFunction(() => /^Analysed/.test(document.getElementById("state").textContent)
      && !document.querySelector("#reactions.stale"));
    await this.page.waitForFunction(() => document.getElementById("start").contentWindow?.pfaffReport);
  }

  text() {
    return this.page.evaluate(() => document.querySelector("#editor .cm-content").cmTile?.view?.state.doc.toString()
      ?? document.querySelector("#editor .cm-content").cmView.view.state.doc.toString());
  }

  /** Replaces the text as a user does. */
  async write(text) {
    await this.page.locator("#editor .cm-content").click();
    await this.page.keyboard.press("Control+a");
    await this.page.keyboard.insertText(text);
  }
}
