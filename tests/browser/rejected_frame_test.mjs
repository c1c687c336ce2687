// A rejected frame is found in the film strip, and looked at beside the accepted one.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch, phone } from "./browser.mjs";
import { colours, pixelsOf } from "./pictures.mjs";
import { Rig } from "./rig.mjs";
import { rejectionsAtLayer4 } from "./scenarios.mjs";
import { until } from "./until.mjs";

let rig;
let browser;
let tab;

before(async () => {
  rig = await Rig.start({ scenario: rejectionsAtLayer4 });
  await rig.runJob();
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

const inStrip = (layer) => tab.page.locator(`[data-role="strip"] [data-layer="${layer}"]`);

test("the rejected ones are marked in the strip, and can be had alone", async () => {
  const { page } = tab;
  await tab.visit(rig.url, "#/layers");
  await inStrip(rig.layers).first().waitFor();
  await page.getByRole("radio", { name: "Rejected" }).check();
  await inStrip(4).first().waitFor();
  assert.equal(await inStrip(4).first().getAttribute("data-verdict"), "rejected");
  assert.equal(await inStrip(2).count(), 0, "layer 2 had no rejected frame");
});

test("each attempt at its layer has its verdict, its reason and its metrics", async () => {
  const { page } = tab;
  await inStrip(4).first().click();
  const { attempts } = await (await rig.ask("/api/v1/layers/4")).json();
  assert.ok(attempts.length > 1);
  for (const { attempt, verdict, reason, metrics } of attempts) {
    const shown = page.locator(`[data-attempt="${attempt}"][data-verdict="${verdict}"]`).first();
    await shown.waitFor();
    if (verdict === "rejected") await page.getByText(reason).first().waitFor();
    const failed = metrics.filter(({ passed }) => !passed);
    assert.equal(failed.length > 0, verdict === "rejected");
  }
  assert.match(page.url(), /#\/layers\/4/);
});

test("rejected and accepted frame are seen side by side", async () => {
  const { page } = tab;
  const { attempts } = await (await rig.ask("/api/v1/layers/4")).json();
  const { attempt } = attempts.find(({ verdict }) => verdict === "rejected");
  await page.locator(`button[data-attempt="${attempt}"]`).click();
  const rejected = page.locator(
    `[data-role="attempt-image"][data-attempt="${attempt}"][data-state="shown"]`,
  );
  const accepted = page.locator('[data-role="layer"][data-layer="4"][data-state="sharp"]');
  await rejected.waitFor();
  await accepted.waitFor();
  for (const picture of [rejected, accepted]) {
    assert.ok(colours(await pixelsOf(picture)) > 100, "a picture is one of nothing");
  }
  const [left, right] = [await accepted.boundingBox(), await rejected.boundingBox()];
  assert.ok(left.x + left.width <= right.x, "they are not side by side");
});

test("the layer is shown sharp, with the map of its sharpness over it when asked", async () => {
  const { page } = tab;
  await page.goto(`${rig.url}/#/layers/5`);
  const picture = page.locator('canvas[data-role="layer"][data-layer="5"][data-state="sharp"]');
  await picture.waitFor();
  assert.ok(colours(await pixelsOf(picture)) > 100, "the picture is one of nothing");
  await page.getByRole("switch", { name: /sharpness/i }).check();
  await page.locator('[data-role="sharpness"]').first().waitFor();
});

test("any layer has a link, and the keys lead from one to the next", async () => {
  const { page } = tab;
  await page.getByRole("radio", { name: "All" }).check();
  await page.goto(`${rig.url}/#/layers/7`);
  await page.locator('canvas[data-role="layer"][data-layer="7"]').waitFor();
  await page.locator('[data-role="strip"]').focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForURL(/#\/layers\/8/);
  await page.keyboard.press("Home");
  await page.waitForURL(/#\/layers\/1(\D|$)/);
  await page.keyboard.press("End");
  await page.waitForURL(new RegExp(`#/layers/${rig.layers}(\\D|$)`));
});

test("the run's list leads to the very attempt that it names", async () => {
  const { page } = tab;
  await page.goto(`${rig.url}/#/run`);
  await page
    .getByRole("link", { name: /^Layer 4, attempt 1/ })
    .first()
    .click();
  await page.locator('[data-role="attempt-image"][data-attempt="1"]').waitFor();
  assert.match(page.url(), /#\/layers\/4\?attempt=1$/);
});

test("on a phone the pictures come into sight when an attempt below them is chosen", async () => {
  const hand = await Tab.open(browser, { ...phone, deviceScaleFactor: 2 });
  try {
    const { page } = hand;
    await hand.visit(rig.url, "#/layers/4");
    await page.locator('button[data-attempt="1"]').waitFor();
    await page.evaluate(() => scrollTo(0, document.body.scrollHeight));
    const picture = page.locator('[data-role="attempt-image"][data-attempt="1"]');
    await page.locator('button[data-attempt="1"]').dispatchEvent("click");
    await picture.waitFor();
    await until("a picture in sight", async () => {
      const { y, height } = await picture.boundingBox();
      return y >= 0 && y + height <= phone.viewport.height;
    });
    hand.assertNoFaults();
  } finally {
    await hand.close();
  }
});

test("nothing failed and nothing was complained of", () => {
  tab.assertNoFaults();
  tab.assertKeptTo(rig.url, rig.token);
});
