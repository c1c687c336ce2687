// What a person does in the explorer, and the pictures that they see there.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { decoded } from "./pictures.mjs";
import { limited } from "./programs.mjs";
import { until } from "./until.mjs";

export const cuboid = (page) => page.locator('canvas[data-role="cuboid"]');
export const section = (page) => page.locator('canvas[data-role="section"]');

/** What is said of the picture on the canvas, at one moment: a preview may follow at the next. */
const said = (canvas) =>
  canvas.evaluate(({ dataset }) => ({ state: dataset.state, command: dataset.command ?? "" }));

/** The section's canvas, once it is sharp; `before`: of another command than this one. */
export async function sharpSection(page, before = "") {
  const canvas = section(page);
  await until(
    "a sharp section",
    async () => {
      const { state, command } = await said(canvas);
      return state === "sharp" && command !== before;
    },
    { said: async () => `${JSON.stringify(await said(canvas))}: ${page.url()}` },
  );
  return canvas;
}

/** The PNG that the command under the canvas makes, by the tool itself. */
export function drawnByTool(command) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "biotomy-browser-"));
  try {
    const environment = { ...process.env, PATH: `${process.env.BIOTOMY_BIN}:${process.env.PATH}` };
    const { status, stderr } = spawnSync("sh", ["-c", command], {
      ...limited,
      cwd: folder,
      env: environment,
    });
    assert.equal(status, 0, `${command}: ${stderr}`);
    const [name] = fs.readdirSync(folder);
    const bytes = fs.readFileSync(path.join(folder, name));
    return { bytes, ...(name.endsWith(".png") ? decoded(bytes) : {}) };
  } finally {
    fs.rmSync(folder, { recursive: true, force: true });
  }
}

/** Where the draggable points of the plane are on the screen. */
export async function handles(page) {
  const canvas = cuboid(page);
  const { x, y } = await canvas.boundingBox();
  const points = JSON.parse(await canvas.getAttribute("data-handles"));
  return points.map(([px, py]) => ({ x: x + px, y: y + py }));
}

/** Drags the point with that number by so many pixels of the screen, as a hand does. */
export async function dragHandle(page, index, dx, dy) {
  const { x, y } = (await handles(page))[index];
  await page.mouse.move(x, y);
  await page.mouse.down();
  const steps = 8;
  for (let step = 1; step <= steps; ++step) {
    await page.mouse.move(x + (dx * step) / steps, y + (dy * step) / steps);
  }
  await page.mouse.up();
}
