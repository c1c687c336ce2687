// The daemon is killed and started again while somebody looks at it.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { Rig } from "./rig.mjs";

let rig;
let browser;
let tab;

before(async () => {
  rig = await Rig.start({ layers: 12, timeScale: 60 });
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

const banner = () => tab.page.getByRole("status").filter({ hasText: "Connection lost" });

test("a lost connection is shown at once", async () => {
  const { page } = tab;
  await tab.visit(rig.url, "#/run");
  await rig.command("start");
  await rig.reaches("two layers", ({ committed }) => committed >= 2);
  assert.equal(await banner().count(), 0);
  await rig.endDaemon("SIGKILL");
  // Well before the 12 s of silence that a network without a word takes.
  await banner().waitFor({ timeout: 5000 });
  assert.equal(await page.locator("body").getAttribute("data-connection"), "lost");
  assert.match(await page.title(), /Connection lost/);
});

test("it comes back by itself, and shows what is now", async () => {
  const { page } = tab;
  const mark = await page.evaluate(() => (window.notLoadedAnew = Math.random()));
  await rig.startDaemon();
  await tab.isLive();
  await banner().waitFor({ state: "hidden" });
  const { state } = await rig.status();
  await page.locator(`header [data-state="${state}"]`).waitFor();
  assert.equal(await page.evaluate(() => window.notLoadedAnew), mark, "the page was loaded anew");
});

test("a daemon that is silent, though its connection stands, is lost too", async () => {
  const { page } = tab;
  rig.freezeDaemon();
  await page.locator('body[data-connection="lost"]').waitFor({ timeout: 30_000 });
  rig.thawDaemon();
  await tab.isLive();
});

test("the run goes on, and the page follows it to its end", async () => {
  const { page } = tab;
  // The controller stopped its wheel when its master fell silent: an operator sees to it.
  await rig.takeUpAgain();
  await page.locator('header [data-state="done"]').waitFor({ timeout: 240_000 });
  const progress = page.getByRole("progressbar");
  assert.equal(await progress.evaluate(({ value }) => value), rig.layers);
});

test("nothing but the loss was complained of", () =>
  tab.assertNoFaults([
    /ERR_CONNECTION_(REFUSED|RESET)/,
    /ERR_INCOMPLETE_CHUNKED_ENCODING/,
    /ERR_EMPTY_RESPONSE/,
    /ERR_CONNECTION_CLOSED/,
  ]));
