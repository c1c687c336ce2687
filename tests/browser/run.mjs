// Runs one test file, or says aloud that it cannot be run here.
// usage: node run.mjs FILE [BROWSER]     BROWSER: without it FILE is skipped
import fs from "node:fs";
import path from "node:path";

const skipped = 77; // CMakeLists.txt tells ctest so

const [file, browser] = process.argv.slice(2);
if (browser && !fs.existsSync(browser)) {
  console.log(`SKIPPED: there is no ${browser}: install chromium (scripts/bootstrap does)`);
  process.exit(skipped);
}
await import(path.resolve(file));
