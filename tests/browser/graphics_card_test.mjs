// The block drawn by the graphics card, for which Chromium's own software stands in, and by the
// page's own means where there is none.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { cuboid, sharpSection } from "./explorer.mjs";
import { assertSame, colours, decoded } from "./pictures.mjs";
import { Rig } from "./rig.mjs";
import { until } from "./until.mjs";

let rig;

before(async () => {
  rig = await Rig.start();
  await rig.runJob();
});
after(() => rig?.stop());

/** The explorer in a browser with these arguments. */
async function withExplorer(args, use) {
  const browser = await launch(args);
  try {
    const tab = await Tab.open(browser);
    await tab.visit(rig.url, "#/explorer");
    await sharpSection(tab.page);
    await use(tab);
    tab.assertNoFaults();
  } finally {
    await browser.close();
  }
}

const isWebgl = (canvas) => canvas.evaluate((element) => element.getContext("webgl2") !== null);

/** The block with the section in it, as it is seen once it no longer changes. */
async function seen(canvas) {
  const fewest = 100; // colours of a section; lines alone have fewer
  let last = await canvas.screenshot();
  await until("a block that stands still, with the section in it", async () => {
    const before = last;
    last = await canvas.screenshot();
    return last.equals(before) && colours(decoded(last)) > fewest;
  });
  return decoded(last);
}

const software = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

test("a graphics card that is lost and comes back shows the block again", async () => {
  await withExplorer(software, async ({ page }) => {
    const canvas = cuboid(page);
    assert.ok(await isWebgl(canvas), "this Chromium has no WebGL: nothing is tested");
    const block = await seen(canvas);
    await canvas.evaluate((element) => {
      const extension = element.getContext("webgl2").getExtension("WEBGL_lose_context");
      element.addEventListener("webglcontextlost", () =>
        setTimeout(() => extension.restoreContext()),
      );
      element.addEventListener("webglcontextrestored", () => (window.restored = true));
      extension.loseContext();
    });
    await until("the context again", () => page.evaluate(() => window.restored === true));
    assertSame(await seen(canvas), block, "after the loss");
  });
});

test("without a graphics card the block is drawn all the same", async () => {
  await withExplorer(["--disable-3d-apis"], async ({ page }) => {
    const canvas = cuboid(page);
    assert.ok(!(await isWebgl(canvas)), "it was drawn by WebGL: nothing is tested");
    await seen(canvas);
  });
});
