// A picture and a film are exported from the page, downloaded and looked at.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { drawnByTool, sharpSection } from "./explorer.mjs";
import { askedForToken, giveToken } from "./operator.mjs";
import { Rig } from "./rig.mjs";
import { until } from "./until.mjs";

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

const exportsOfRig = async () => (await (await rig.ask("/api/v1/exports")).json()).exports;

/** Presses "Export" and waits for the end: its JSON, and the file that is then downloaded. */
async function exported(dialog, extension, token) {
  const { page } = tab;
  const before = (await exportsOfRig()).length;
  await dialog.getByRole("button", { name: "Export", exact: true }).click();
  if (token) await giveToken(page, token);
  await until("an export", async () => (await exportsOfRig()).length > before);
  const [{ id }] = await exportsOfRig();
  const job = page.locator(`[data-role="export"][data-id="${id}"][data-state="done"]`);
  await job.waitFor({ timeout: 240_000 });
  const state = await (await rig.ask(`/api/v1/exports/${id}`)).json();
  const { name, bytes } = state.files.find((file) => file.name.endsWith(extension));
  const started = page.waitForEvent("download");
  const link = { name: new RegExp(name) };
  await job.getByRole("link", link).or(job.getByRole("button", link)).first().click();
  const download = await started;
  // What is saved beside others also names its sample.
  assert.ok(download.suggestedFilename().endsWith(name), download.suggestedFilename());
  const file = await download.path();
  const content = fs.readFileSync(file);
  assert.equal(content.length, bytes);
  return { state, content, file };
}

test("a PNG at full resolution is, byte by byte, the tool's", async () => {
  const { page } = tab;
  await tab.visit(rig.url, "#/explorer");
  await sharpSection(page);
  const dialog = await openExport();
  const { state, content } = await exported(dialog, ".png", rig.token);
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
  const { state, file } = await exported(dialog, ".mp4");
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
      file,
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
