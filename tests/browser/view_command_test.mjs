// `biotomy view`: the same explorer for an imported sample, without a rig.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { checkAnswer, operations } from "./contract.mjs";
import { drawnByTool, sharpSection } from "./explorer.mjs";
import { ImportedSample } from "./imported_sample.mjs";
import { assertSame, pixelsOf } from "./pictures.mjs";

let view;
let url;
let browser;
let tab;

before(async () => {
  view = await ImportedSample.show({ x: 120, y: 90, z: 20 }, "a sample's own");
  url = view.url;
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await view?.stop();
});

test("the page begins with the explorer, and has no view of a run", async () => {
  const { page } = tab;
  await page.goto(url);
  await page.locator('main[data-view="explorer"]').waitFor();
  const views = await page.getByRole("navigation").first().getByRole("link").allTextContents();
  assert.deepEqual(views, ["Layers", "Explorer"]);
  const { kind, commands_need_token: token } = await (await fetch(`${url}/api/v1/service`)).json();
  assert.deepEqual([kind, token], ["view", false]);
});

test("its section is the tool's, pixel by pixel", async () => {
  const canvas = await sharpSection(tab.page);
  const command = await canvas.getAttribute("data-command");
  assertSame(await pixelsOf(canvas), drawnByTool(command), command);
});

test("its layers are shown, and that nothing was measured is said plainly", async () => {
  const { page } = tab;
  await page.goto(`${url}/#/layers/3`);
  await page.locator('canvas[data-role="layer"][data-layer="3"][data-state="sharp"]').waitFor();
  await page
    .getByText(/import|no journal|not judged|no metrics|no attempts/i)
    .first()
    .waitFor();
});

test("it exports without a token", async () => {
  const { page } = tab;
  await page.goto(`${url}/#/explorer`);
  await sharpSection(page);
  await page
    .getByRole("button", { name: /^Export/ })
    .first()
    .click();
  const dialog = page.getByRole("dialog", { name: /export/i });
  await dialog.getByRole("button", { name: "Export", exact: true }).click();
  await page.locator('[data-role="export"][data-state="done"]').first().waitFor();
});

test("there is no rig to command", async () => {
  for (const path of ["/api/v1/status", "/api/v1/control/start", "/metrics"]) {
    const method = path.includes("control") ? "POST" : "GET";
    assert.equal((await fetch(url + path, { method })).status, 404, path);
  }
});

test("what it answers is as documented", async () => {
  const section = "?normal=1,1,2&through=400,300,100";
  const targets = {
    getService: "/api/v1/service",
    getSample: "/api/v1/sample",
    getLayers: "/api/v1/layers",
    getLayer: "/api/v1/layers/3",
    getLayerImage: "/api/v1/layers/3/image",
    getLayerSharpness: "/api/v1/layers/3/sharpness",
    getRejected: "/api/v1/rejected",
    getHistory: "/api/v1/history?metrics=brightness",
    getSection: `/api/v1/section${section}`,
    getSectionOutline: `/api/v1/section/outline${section}`,
    getExports: "/api/v1/exports",
  };
  for (const [name, target] of Object.entries(targets)) {
    const operation = operations.find(({ operationId }) => operationId === name);
    const response = await fetch(url + target);
    assert.equal(response.status, 200, target);
    await checkAnswer(operation, response, target);
  }
});

test("nothing failed and nothing was complained of", () => {
  tab.assertNoFaults();
  tab.assertKeptTo(url);
});

test("SIGTERM ends it as it should", async () => assert.equal(await view.end("SIGTERM"), 0));
