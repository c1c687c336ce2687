// A picture and a film are exported from the page, downloaded and looked at.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { drawnByTool, sharpSection } from "./explorer.mjs";
import { askedForToken, giveToken } from "./operator.mjs";
import { Rig } from "./rig.mjs";

let rig;
let browser;
let tab;

before(async () => {
  rig = await Rig.start();
  await rig.runJob();
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

async function openExport() {
  await tab.page
    .getByRole("button", { name: /^Export/ })
    .first()
    .click();
  const dialog = tab.page.getByRole("dialog", { name: /export/i });
  await dialog.waitFor();
  return dialog;
}

/** Its JSON as the rig has it, and what was downloaded from the page. */
async function exported(dialog, extension) {
  const { page } = tab;
  const job = page.locator('[data-role="export"][data-state="done"]').first();
  await job.waitFor();
  const id = await job.getAttribute("data-id");
  const state = await (await rig.ask(`/api/v1/exports/${id}`)).json();
  const { name, bytes } = state.files.find((file) => file.name.endsWith(extension));
  const started = page.waitForEvent("download");
  await job
    .getByRole("link", { name: new RegExp(name) })
    .or(job.getByRole("button", { name: new RegExp(name) }))
    .first()
    .click();
  const download = await started;
  assert.equal(download.suggestedFilename(), name);
  const content = fs.readFileSync(await download.path());
  assert.equal(content.length, bytes);
  return { state, content, path: await download.path() };
}

test("a PNG at full resolution is, byte by byte, the tool's", async () => {
  const { page } = tab;
  await tab.visit(rig.url, "#/explorer");
  await sharpSection(page);
  const dialog = await openExport();
  await dialog.getByRole("button", { name: "Export", exact: true }).click();
  await giveToken(page, rig.token);
  const { state, content } = await exported(dialog, ".png");
  assert.ok(drawnByTool(state.command).bytes.equals(content), state.command);
});

test("a film of a rotation has the frames that were asked for", async () => {
  const { page } = tab;
  const dialog = page.getByRole("dialog", { name: /export/i });
  if (!(await dialog.isVisible())) await openExport();
  await dialog
    .getByLabel(/^Series/)
    .first()
    .check();
  await dialog.getByLabel(/^Film/).first().check();
  await dialog.getByRole("button", { name: "Export", exact: true }).click();
  const { state, path } = await exported(dialog, ".mp4");
  const { stdout, stderr } = spawnSync(
    "ffprobe",
    [
      "-v",
      "error",
      "-count_frames",
      "-select_streams",
      "v:0",
      "-show_entries",
      "stream=nb_read_frames",
      "-of",
      "csv=p=0",
      path,
    ],
    { encoding: "utf8" },
  );
  assert.equal(Number(stdout.trim().replace(",", "")), state.total, stderr);
  assert.ok(state.total > 1);
});

test("the token is in no address and the daemon's log has none", () => {
  tab.assertKeptTo(rig.url, rig.token);
  assert.ok(!rig.log.includes(rig.token));
});

test("nothing failed and nothing was complained of", () => tab.assertNoFaults([askedForToken]));
