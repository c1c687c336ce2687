// A sample of ten thousand layers: the strip holds what is seen, whatever there is.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { ImportedSample } from "./imported_sample.mjs";
import { until } from "./until.mjs";

const layers = 10_000;
const mostFrames = 60; // of the strip in the document: those in the window and a few beside it

let view;
let browser;
let tab;

before(async () => {
  view = await ImportedSample.show({ x: 24, y: 18, z: layers }, "deep");
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await view?.stop();
});

const strip = () => tab.page.locator('[data-role="strip"]');
const frames = () => strip().locator("[data-layer]");
const frame = (layer) => strip().locator(`[data-layer="${layer}"]`);
const thumbnails = () => tab.requests.filter(({ url }) => /\/image\?width=/.test(url)).length;

async function assertFew(where) {
  const count = await frames().count();
  assert.ok(count > 3 && count <= mostFrames, `${where}: ${count} frames`);
}

test("a link leads into the middle of it", async () => {
  await tab.visit(view.url, "#/layers/5000");
  await frame(5000).locator("img").waitFor();
  await assertFew("in the middle");
  assert.equal(await frame(5000).getAttribute("aria-setsize"), String(layers));
});

test("the keys lead to both ends of it", async () => {
  const { page } = tab;
  await strip().focus();
  await page.keyboard.press("End");
  await frame(layers).locator("img").waitFor();
  await assertFew("at the end");
  await page.keyboard.press("Home");
  await frame(1).locator("img").waitFor();
  await assertFew("at the beginning");
});

test("what is scrolled past is not fetched", async () => {
  const before = thumbnails();
  await strip().evaluate(async (element) => {
    const steps = 200;
    for (let step = 1; step <= steps; ++step) {
      element.scrollLeft = (element.scrollWidth * step) / steps;
      await new Promise((resolve) => requestAnimationFrame(resolve));
    }
  });
  await until("the last layer's picture", () => frame(layers).locator("img").isVisible());
  await assertFew("after all was scrolled past");
  // Two hundred windows were gone through.
  const fetched = thumbnails() - before;
  assert.ok(fetched <= 10 * mostFrames, `${fetched} pictures were fetched`);
});

test("nothing failed and nothing was complained of", () => tab.assertNoFaults());
