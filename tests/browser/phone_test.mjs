// The page on a phone: nothing to scroll sideways for, nothing too small for a finger.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch, phone } from "./browser.mjs";
import { Rig } from "./rig.mjs";
import { rejectionsAtLayer4 } from "./scenarios.mjs";
import { open, views } from "./views.mjs";

const narrowest = 360; // CSS pixels
const leastTarget = 24; // CSS pixels, WCAG 2.2, 2.5.8

let rig;
let browser;

before(async () => {
  rig = await Rig.start({ layers: 6, scenario: rejectionsAtLayer4 });
  await rig.runJob();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

/** What sticks out of the window to the right. */
const sidewards = (page) =>
  page.evaluate(() => {
    const { scrollWidth, clientWidth } = document.scrollingElement;
    if (scrollWidth <= clientWidth) return [];
    return [...document.querySelectorAll("body *")]
      .filter((element) => element.getBoundingClientRect().right > clientWidth + 1)
      .map((element) => element.outerHTML.slice(0, 120));
  });

/** What one may touch and is too small; a link in a sentence may be as high as its line. */
const tooSmall = (page, least) =>
  page.evaluate((pixels) => {
    const touched =
      "a[href], button, input, select, textarea, summary, [role=button], [role=slider]";
    return (
      [...document.querySelectorAll(touched)]
        .filter((element) =>
          element.checkVisibility({ visibilityProperty: true, opacityProperty: true }),
        )
        .filter((element) => !(element.tagName === "A" && element.closest("p, li, td")))
        .map((element) => ({
          element,
          area: (element.closest("label") ?? element).getBoundingClientRect(),
        }))
        // What is off the screen until it has the focus is not for fingers.
        .filter(({ area }) => area.right > 0 && area.bottom > 0 && area.width > 1)
        .filter(({ area }) => area.width < pixels || area.height < pixels)
        .map(
          ({ element, area }) =>
            `${area.width.toFixed(0)} × ${area.height.toFixed(0)} ${element.outerHTML.slice(0, 120)}`,
        )
    );
  }, least);

for (const view of views) {
  test(`${view.name} fits a phone and its fingers`, async () => {
    const tab = await Tab.open(browser, { ...phone, deviceScaleFactor: 3 });
    try {
      await open(tab, rig.url, view);
      assert.deepEqual(await sidewards(tab.page), []);
      assert.deepEqual(await tooSmall(tab.page, leastTarget), []);
      tab.assertNoFaults();
    } finally {
      await tab.close();
    }
  });
  test(`${view.name} fits ${narrowest} pixels`, async () => {
    const tab = await Tab.open(browser, { viewport: { width: narrowest, height: 640 } });
    try {
      await open(tab, rig.url, view);
      assert.deepEqual(await sidewards(tab.page), []);
    } finally {
      await tab.close();
    }
  });
}

test("a layer is chosen by a finger", async () => {
  const tab = await Tab.open(browser, { ...phone, deviceScaleFactor: 2 });
  try {
    await open(tab, rig.url, views[1]);
    await tab.page.locator('[data-role="strip"] [data-layer="3"]').first().tap();
    await tab.page.waitForURL(/#\/layers\/3/);
    await tab.page
      .locator('canvas[data-role="layer"][data-layer="3"][data-state="sharp"]')
      .waitFor();
    tab.assertNoFaults();
  } finally {
    await tab.close();
  }
});
