// `biotomy view`: the same explorer for an imported sample, without a rig.
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { PNG } from "pngjs";
import { Tab, launch } from "./browser.mjs";
import { drawnByTool, sharpSection } from "./explorer.mjs";
import { assertSame, pixelsOf } from "./pictures.mjs";
import { Program, biotomy } from "./programs.mjs";

const size = { x: 120, y: 90, z: 20 };

let folder;
let view;
let url;
let browser;
let tab;

/** Layers of colours that differ at every voxel. */
function writeImages(into) {
  fs.mkdirSync(into);
  for (let z = 0; z < size.z; ++z) {
    const image = new PNG({ width: size.x, height: size.y });
    for (let y = 0; y < size.y; ++y) {
      for (let x = 0; x < size.x; ++x) {
        image.data.set([x * 2, y * 2, (z * 12 + x * y) % 256, 255], (y * size.x + x) * 4);
      }
    }
    fs.writeFileSync(path.join(into, `${String(z).padStart(3, "0")}.png`), PNG.sync.write(image));
  }
}

before(async () => {
  folder = fs.mkdtempSync(path.join(os.tmpdir(), "biotomy-browser-"));
  writeImages(path.join(folder, "images"));
  const sample = path.join(folder, "a sample's own");
  const made = biotomy(
    "import",
    path.join(folder, "images"),
    "--spacing",
    "10,10,20",
    "-o",
    sample,
  );
  assert.equal(made.status, 0, made.stderr);
  view = new Program(
    "biotomy",
    ["view", sample, "--listen", "127.0.0.1:0", "--no-browser"],
    folder,
  );
  url = `http://${(await view.says("http://")).replace(/[/\s].*$/, "")}`;
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await view?.end("SIGKILL");
  if (folder) fs.rmSync(folder, { recursive: true, force: true });
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

test("nothing failed and nothing was complained of", () => {
  tab.assertNoFaults();
  tab.assertKeptTo(url);
});

test("SIGTERM ends it as it should", async () => assert.equal(await view.end("SIGTERM"), 0));
