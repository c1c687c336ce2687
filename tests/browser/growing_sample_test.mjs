// The layers and the explorer while the block is still being ground.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { drawnByTool, section, sharpSection } from "./explorer.mjs";
import { assertSame, pixelsOf } from "./pictures.mjs";
import { Rig } from "./rig.mjs";
import { until } from "./until.mjs";

let rig;
let browser;
let explorer;
let layers;

before(async () => {
  rig = await Rig.start({ layers: 30, timeScale: 40 });
  browser = await launch();
  explorer = await Tab.open(browser);
  layers = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

/** The depth of the face that the section of this command shows, in layers from 1. */
const layerOf = (command) => {
  const [, z] = /--through=[^,]*,[^,]*,([-\d.]+)/.exec(command) ?? [];
  return Math.round(Number(z ?? 0) / 40) + 1;
};

test("before the first layer the views say that there is none", async () => {
  await layers.visit(rig.url, "#/layers");
  await layers.page
    .getByText(/no layer/i)
    .first()
    .waitFor();
  await explorer.visit(rig.url, "#/explorer");
  await explorer.page
    .getByText(/no layer|nothing .*yet|not .*yet/i)
    .first()
    .waitFor();
});

// However slow the page is beside the rig: the rig waits for it, three times.
test("the newest face is shown as it comes", async () => {
  const { page } = explorer;
  let committed = 0;
  for (const command of ["start", "resume", "resume"]) {
    const before = committed;
    await rig.command(command);
    await rig.reaches("another layer", (status) => status.committed > before);
    await rig.command("pause");
    ({ committed } = await rig.reaches("the pause", ({ state }) => state === "paused"));
    if (before === 0) {
      await section(page).waitFor();
      await page.getByRole("switch", { name: "Newest face" }).check();
    }
    await until(`the face of layer ${committed}`, async () => {
      const shown = await section(page).getAttribute("data-command");
      return shown !== null && layerOf(shown) === committed;
    });
  }
  await rig.command("resume");
});

test("the strip follows the job without being asked for anew", async () => {
  const { page } = layers;
  await page
    .locator(`[data-role="strip"] [data-layer="${rig.layers / 2}"]`)
    .first()
    .waitFor();
});

test("at the end the last face is the tool's, and the strip has all layers", async () => {
  const { page } = explorer;
  await rig.reaches("the end", ({ state }) => state === "done");
  await until("the last face", async () => {
    const command = await (await sharpSection(page)).getAttribute("data-command");
    return layerOf(command) === rig.layers;
  });
  const canvas = await sharpSection(page);
  const command = await canvas.getAttribute("data-command");
  assertSame(await pixelsOf(canvas), drawnByTool(command), command);
  await layers.page.locator(`[data-role="strip"] [data-layer="${rig.layers}"]`).first().waitFor();
});

test("nothing failed and nothing was complained of", () => {
  for (const tab of [explorer, layers]) {
    tab.assertNoFaults();
    assert.equal(tab.requests.filter(({ url }) => url.endsWith("/api/v1/events")).length, 1);
  }
});
