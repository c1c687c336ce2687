// Makes the README's pictures of the page: a real daemon and the twin, half-way through a job.
// usage: node screenshots.mjs FOLDER
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { Tab, launch, phone } from "./browser.mjs";
import { sharpSection } from "./explorer.mjs";
import { Rig } from "./rig.mjs";
import { until } from "./until.mjs";

const [, , folder] = process.argv;
const layers = 60;
const shownAt = 44; // layers
const window = { width: 1280, height: 800 };
const mostBytes = 300_000; // of a picture in the repository

const debris = `about = "The air nozzle is clogged now and then."
[events.nozzle]
fault = "debris_sticks"
when = { grind_finished = 8, every = 9 }
lasts = { captures = 2 }
`;

/** Few colours are enough to show a page, and take a third of the room. */
function reduced(from, to) {
  const palette =
    "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=dither=sierra2_4a";
  const { status, stderr } = spawnSync(
    "ffmpeg",
    ["-v", "error", "-y", "-i", from, "-vf", palette, to],
    {
      encoding: "utf8",
    },
  );
  if (status !== 0) throw new Error(`ffmpeg: ${stderr}`);
}

async function take(page, name) {
  const whole = path.join(os.tmpdir(), `biotomy-${process.pid}-${name}.png`);
  const picture = path.join(folder, `page-${name}.png`);
  try {
    await page.mouse.move(0, 0);
    await page.screenshot({ path: whole });
    reduced(whole, picture);
  } finally {
    fs.rmSync(whole, { force: true });
  }
  const bytes = fs.statSync(picture).size;
  console.log(`${picture}: ${Math.round(bytes / 1000)} KB`);
  if (bytes > mostBytes) throw new Error(`${picture} is larger than ${mostBytes} bytes`);
}

/** All pictures and previews that the page is still waiting for are there. */
const settled = (page) => page.waitForLoadState("load").then(() => page.waitForTimeout(1500));

const rig = await Rig.start({
  layers,
  sample: "knee",
  width: 800,
  height: 600,
  pixel: 10,
  thickness: 20,
  timeScale: 25,
  scenario: debris,
});
const browser = await launch();
try {
  const tab = await Tab.open(browser, { viewport: window, colorScheme: "light" });
  const { page } = tab;
  await tab.visit(rig.url, "#/run");
  await rig.command("start");
  await rig.reaches("most of the job", ({ committed }) => committed >= shownAt, 600);
  await page.locator('header [data-state="grinding"]').waitFor();
  await take(page, "run");

  const onPhone = await Tab.open(browser, { ...phone, deviceScaleFactor: 1.5 });
  await onPhone.visit(rig.url, "#/run");
  await settled(onPhone.page);
  await take(onPhone.page, "phone");
  await onPhone.close();

  rig.hand("press", "estop");
  await page.getByRole("alert").waitFor();
  await take(page, "alarm");
  rig.hand("release", "estop");

  const { rejected } = await (await rig.ask("/api/v1/rejected")).json();
  const { layer, attempt } = rejected[0];
  await page.goto(`${rig.url}/#/layers/${layer}`);
  await page.locator(`button[data-attempt="${attempt}"]`).click();
  await page.locator('[data-role="attempt-image"][data-state="shown"]').waitFor();
  await rig.takeUpAgain();
  await page.getByRole("alert").waitFor({ state: "detached" });
  await settled(page);
  await take(page, "layers");

  await rig.reaches("the end", ({ state }) => state === "done", 600);
  // Cuts the block in a hexagon.
  const points = "3995,0,1180 0,2995,1180 7990,0,590";
  await page.goto(`${rig.url}/#/explorer?points=${encodeURIComponent(points)}`);
  await sharpSection(page);
  await until("the block in 3D", () => page.locator("[data-handles]").isVisible());
  await settled(page);
  await take(page, "explorer");
} finally {
  await browser.close();
  await rig.stop();
}
