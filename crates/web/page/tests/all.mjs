// Tests of the page: node tests/all.mjs OUT [NAME …]

import { readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { serve } from "./server.mjs";

const [out, ...wanted] = process.argv.slice(2);
if (!out) throw new Error("usage: node tests/all.mjs OUT [NAME …]");
const here = join(dirname(fileURLToPath(import.meta.url)), "cases");
const server = await serve(out);
let failed = 0;
for (const file of readdirSync(here).filter((name) => name.endsWith(".mjs")).sort()) {
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
