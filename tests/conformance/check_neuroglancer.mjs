// A neuroglancer page in a headless Chromium shows a slice of the store, served over HTTP; the
// colours of the screenshot are compared with the voxels' own.
import fs from "node:fs";
import path from "node:path";
import puppeteer from "puppeteer-core";
import { serve } from "./file_server.mjs";
import { makePage } from "./neuroglancer_page.mjs";
import { check, skip } from "./table.mjs";
import { at } from "./voxels.mjs";

const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find((name) => fs.existsSync(name));
const zoom = 4; // pixels of the screen along the finest axis of a voxel

/** The slice z, the middle of the block in the middle of the window. A voxel's centre has its number
 * as its coordinate, as OME-Zarr has it. Nothing is said of colours: those are the metadata's. */
function state(url, spacing, [nz, ny, nx], z) {
  const metres = spacing.map((um) => um * 1e-6);
  return {
    dimensions: { x: [metres[2], "m"], y: [metres[1], "m"], z: [metres[0], "m"] },
    position: [nx / 2, ny / 2, z],
    crossSectionScale: 1 / zoom,
    layers: [{ type: "new", name: "volume", source: `zarr3://${url}` }],
    selectedLayer: { layer: "volume", visible: true },
    layout: "xy", showAxisLines: false, showScaleBar: false, showDefaultAnnotations: false,
  };
}

/** Presses "Create as multi-channel image layer", as a person does who opens a volume by its URL, and
 * closes the panel. */
async function showAllChannels(page) {
  const button = await page.waitForSelector("::-p-text(multi-channel image)", { visible: true, timeout: 60000 });
  await button.click();
  await page.waitForFunction(() => {
    const layers = window.viewer.layerManager.managedLayers;
    return layers.length === 3 && layers.every((layer) => layer.isReady());
  }, { timeout: 60000 });
  const names = await page.evaluate(() => {
    window.viewer.selectedLayer.visible = false;
    return window.viewer.layerManager.managedLayers.map(({ name }) => name).join(", ");
  });
  // Without omero it knows their numbers alone, and after a second stretches their contrast.
  if (names !== "volume red, volume green, volume blue") throw new Error(`takes the channels for ${names}`);
}

async function screenshot(page, file) {
  const png = await page.screenshot({ path: file });
  return page.evaluate(async (data) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return { width: image.width, bytes: Array.from(context.getImageData(0, 0, image.width, image.height).data) };
  }, Buffer.from(png).toString("base64"));
}

/** Where the middle of the picture lies on the screen. */
function middle(page) {
  return page.evaluate(() => {
    const panel = document.querySelector(".neuroglancer-rendered-data-panel").getBoundingClientRect();
    return [panel.left + panel.width / 2, panel.top + panel.height / 2];
  });
}

export async function checkNeuroglancer(name, store, finest, spacing, work, pages) {
  if (!chromium) {
    skip(name, "neuroglancer in Chromium", "this system has no chromium");
    return;
  }
  const version = await makePage(pages);
  const server = await serve({ page: path.join(pages, "page"), "async_computation.bundle.js": path.join(pages, "async_computation.bundle.js"), [path.basename(store)]: store });
  const browser = await puppeteer.launch({ executablePath: chromium, headless: true,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
  try {
    const page = await browser.newPage();
    const said = [];
    page.on("console", (message) => said.push(message.text()));
    page.on("pageerror", (error) => said.push(error.message));
    await page.setViewport({ width: 900, height: 700 });
    const [, ...size] = finest.shape;
    const z = Math.floor(size[0] / 2);
    const finestAxis = Math.min(...spacing);
    const wanted = state(`${server.origin}/${path.basename(store)}/`, spacing, size, z);
    await page.goto(`${server.origin}/page/index.html#!${encodeURIComponent(JSON.stringify(wanted))}`);
    const file = path.join(work, `neuroglancer-${name.replaceAll(/\W+/g, "-")}.png`);
    await check(name, `neuroglancer ${version}: slice z ${z}`, async () => {
      await showAllChannels(page);
      await page.waitForFunction(() => window.viewer?.isReady?.(), { timeout: 60000 })
        .catch(() => { throw new Error(`is not ready: ${said.at(-1) ?? "it says nothing"}`); });
      const picture = await screenshot(page, file);
      const [u, v] = await middle(page);
      let compared = 0;
      let worst = 0;
      for (let y = 2; y < size[1] - 2; y += 7)
        for (let x = 2; x < size[2] - 2; x += 7) {
          const column = Math.floor(u + (x - size[2] / 2) * zoom * (spacing[2] / finestAxis));
          const row = Math.floor(v + (y - size[1] / 2) * zoom * (spacing[1] / finestAxis));
          for (let c = 0; c < 3; ++c) {
            const value = at(finest, c, z, y, x);
            const level = finest.data.BYTES_PER_ELEMENT === 1 ? value : value / 257;
            worst = Math.max(worst, Math.abs(picture.bytes[(row * picture.width + column) * 4 + c] - level));
            ++compared;
          }
        }
      if (worst > 2) throw new Error(`a colour is ${worst.toFixed(0)} levels off: ${file}; ${said.at(-1) ?? ""}`);
      return `${compared} colours, at most ${worst.toFixed(1)} levels off: ${path.basename(file)}`;
    });
  } finally {
    await browser.close();
    server.close();
  }
}
