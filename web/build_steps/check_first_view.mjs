// Fails when what a browser loads before it shows the first view is too much.
// usage: node check_first_view.mjs DIST
import { readFileSync } from "node:fs";
import { join } from "node:path";

import { gzip } from "./gzip.mjs";

const limit_kib = 300;

/** index.html, what it names, and what those import without being asked for later. */
function filesOfFirstView(dist) {
  const html = readFileSync(join(dist, "index.html"), "utf8");
  const named = [...html.matchAll(/(?:src|href)="\/([^"]+)"/g)].map((match) => match[1]);
  const manifest = JSON.parse(readFileSync(join(dist, ".vite", "manifest.json"), "utf8"));
  const files = new Set(["index.html", ...named]);
  const seen = new Set();
  const follow = (key) => {
    if (seen.has(key)) return;
    seen.add(key);
    const chunk = manifest[key];
    for (const file of [chunk.file, ...(chunk.css ?? []), ...(chunk.assets ?? [])]) files.add(file);
    (chunk.imports ?? []).forEach(follow);
  };
  Object.keys(manifest)
    .filter((key) => manifest[key].isEntry)
    .forEach(follow);
  return [...files].sort();
}

const [dist] = process.argv.slice(2);
if (!dist) {
  console.error("check_first_view: give the folder that Vite wrote");
  process.exit(2);
}
const sizes = filesOfFirstView(dist).map((file) => ({
  file,
  bytes: gzip(readFileSync(join(dist, file))).length,
}));
const total = sizes.reduce((sum, { bytes }) => sum + bytes, 0);
for (const { file, bytes } of sizes) console.log(`${String(bytes).padStart(8)}  ${file}`);
console.log(`${String(total).padStart(8)}  in all; the limit is ${limit_kib * 1024}`);
process.exit(total < limit_kib * 1024 ? 0 : 1);
