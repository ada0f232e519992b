// Tests of the page: node tests/all.mjs OUT [--times] [NAME …]; with --times also those that measure times

import { readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { serve } from "./server.mjs";

const [out, ...words] = process.argv.slice(2);
if (!out) throw new Error("usage: node tests/all.mjs OUT [--times] [NAME …]");
const wanted = words.filter((word) => word !== "--times");
const here = dirname(fileURLToPath(import.meta.url));
const folders = words.includes("--times") ? ["cases", "times"] : ["cases"];
const files = folders.flatMap((folder) => readdirSync(join(here, folder)).map((file) => join(folder, file)));
const server = await serve(out);
let failed = 0;
for (const file of files.sort()) {
  const tests = await import(pathToFileURL(join(here, file)));
  for (const [name, test] of Object.entries(tests)) {
    const title = `${file.replace(".mjs", "")}: ${name}`;
    if (wanted.length && !wanted.some((own) => title.includes(own))) continue;
    const begun = performance.now();
    try {
      const remark = await test(server);
      console.log(`ok   ${title} (${Math.round(performance.now() - begun)} ms)${remark ? `: ${remark}` : ""}`);
    } catch (error) {
      failed += 1;
      console.log(`FAIL ${title}\n${error.stack}`);
    }
  }
}
server.close();
console.log(failed ? `${failed} tests failed` : "all tests passed");
process.exit(failed ? 1 : 0);
