// More tabs of one browser than it opens connections to a server, which are six.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { askedForToken, command } from "./operator.mjs";
import { Rig } from "./rig.mjs";
import { until } from "./until.mjs";

const tabCount = 8;

let rig;
let browser;
let tab;
let pages;

before(async () => {
  rig = await Rig.start({ layers: 80, timeScale: 60 });
  browser = await launch();
  tab = await Tab.open(browser);
  // A headless browser calls each of its tabs visible, and nobody listens to it.
  await tab.context.addInitScript(() => {
    let seen = true;
    const state = () => (seen ? "visible" : "hidden");
    Object.defineProperty(Document.prototype, "visibilityState", { get: state });
    window.setSeen = (now) => {
      seen = now;
      document.dispatchEvent(new Event("visibilitychange"));
    };
    window.tones = 0;
    const start = OscillatorNode.prototype.start;
    OscillatorNode.prototype.start = function (...when) {
      ++window.tones;
      return start.apply(this, when);
    };
  });
  pages = [tab.page];
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

const setSeen = (page, seen) => page.evaluate((now) => window.setSeen(now), seen);
const connectionOf = (page) => page.locator("body").getAttribute("data-connection");
const isLive = (page) => page.locator('body[data-connection="live"]').waitFor();
const tones = (page) => page.evaluate(() => window.tones);

test("each tab that is opened before the others shows the rig", async () => {
  await tab.visit(rig.url, "#/run");
  while (pages.length < tabCount) {
    await setSeen(pages.at(-1), false);
    const page = await tab.context.newPage();
    await page.goto(`${rig.url}/#/run`, { timeout: 20_000 });
    await isLive(page);
    pages.push(page);
  }
  const states = await Promise.all(pages.map(connectionOf));
  assert.deepEqual(states, [...Array(tabCount - 1).fill("resting"), "live"]);
});

test("the one that is looked at again shows at once what is now, and speaks of no loss", async () => {
  await rig.command("start");
  await rig.reaches("two layers", ({ committed }) => committed >= 2);
  const [page] = pages;
  assert.equal(await page.title(), "sample – Biotomy");
  await setSeen(pages.at(-1), false);
  await setSeen(page, true);
  await isLive(page);
  await until("two layers", async () => {
    const layer = page.locator('[data-role="layer"]');
    return Number(await layer.getAttribute("data-committed")) >= 2;
  });
  assert.equal(await page.getByText("Connection lost").count(), 0);
  assert.equal(await page.locator("main").getAttribute("data-stale"), "false");
});

test("the one that was looked at last tells of an alarm, and sounds it, unseen", async () => {
  const [page] = pages;
  await page.getByRole("switch", { name: /sound/i }).first().check();
  await until("the tone that says that it is switched on", async () => (await tones(page)) > 0);
  await setSeen(page, false);
  const before = await tones(page);
  rig.hand("press", "estop");
  await until("a title", async () => (await page.title()).includes("ALARM"));
  await until("a sound", async () => (await tones(page)) > before);
  assert.equal(await connectionOf(pages[1]), "resting");
});

test("another takes its place when it is closed", async () => {
  const closed = pages.shift();
  const gone = closed.waitForEvent("close");
  await closed.close({ runBeforeUnload: true }); // as by a person: the page is told
  await gone;
  const titles = () => Promise.all(pages.map((page) => page.title()));
  await until(
    "an alarm in another tab's title",
    async () => (await titles()).filter((title) => title.includes("ALARM")).length === 1,
    { said: async () => (await titles()).join(", ") },
  );
});

test("windows side by side all show the rig, and each can command it", async () => {
  await Promise.all(pages.map((page) => setSeen(page, true)));
  await Promise.all(pages.map(isLive));
  const allShow = (state) =>
    Promise.all(pages.map((page) => page.locator(`header [data-state="${state}"]`).waitFor()));
  await allShow("faulted");
  rig.hand("release", "estop");
  await rig.reaches("released", ({ commands }) => commands.includes("acknowledge"));
  const [first] = pages; // that was looked at before all others
  await command(first, "Acknowledge", { token: rig.token });
  await allShow("paused");
  assert.deepEqual(await Promise.all(pages.map(connectionOf)), Array(pages.length).fill("live"));
});

test("nothing failed and nothing was complained of", () => tab.assertNoFaults([askedForToken]));
