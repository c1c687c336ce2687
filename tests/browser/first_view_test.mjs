// The first view is small and soon there.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { loadFirstView } from "./first_view.mjs";
import { Rig } from "./rig.mjs";

const mostBytes = 300 * 1024;
const mostFiles = 16;
const patience = 20; // seconds: `first_view_bench.mjs` tells the true number

let rig;
let browser;

before(async () => {
  rig = await Rig.start({ layers: 4 });
  await rig.runJob();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

test("the first view is under 300 KiB, in few files", async () => {
  const tab = await Tab.open(browser);
  const { files, bytes, seconds } = await loadFirstView(tab, rig.url);
  const list = files.map((file) => `${file.bytes} ${file.url}`).join("\n");
  console.log(
    `${(bytes / 1024).toFixed(1)} KiB in ${files.length} files, ${seconds.toFixed(2)} s\n${list}`,
  );
  assert.ok(files.length > 2, "nothing was counted");
  assert.ok(bytes > 5000, "nothing was counted");
  assert.ok(bytes < mostBytes, list);
  assert.ok(files.length <= mostFiles, list);
  assert.ok(seconds < patience, `${seconds} s`);
  tab.assertNoFaults();
});

test("what was fetched once is kept; the page itself is asked for again", async () => {
  const tab = await Tab.open(browser);
  await loadFirstView(tab, rig.url);
  const page = await rig.ask("/");
  assert.match(page.headers.get("cache-control"), /no-cache/);
  const etag = page.headers.get("etag");
  assert.equal((await rig.ask("/", { headers: { "If-None-Match": etag } })).status, 304);
  const assets = tab.requests.filter(({ url }) => url.includes("/assets/"));
  assert.ok(assets.length > 0);
  for (const { url } of assets) {
    const asset = await rig.ask(new URL(url).pathname);
    assert.match(asset.headers.get("cache-control"), /immutable/, url);
    assert.equal(asset.headers.get("content-encoding"), "gzip", url);
  }
});
