// The e-stop is pressed in the middle of a run: the page shows it wherever one is, and the operator
// acknowledges and goes on.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch, screen } from "./browser.mjs";
import { askedForToken, command } from "./operator.mjs";
import { Rig } from "./rig.mjs";
import { until } from "./until.mjs";

let rig;
let browser;
let tab;

before(async () => {
  rig = await Rig.start({ layers: 10, timeScale: 60 });
  browser = await launch();
  tab = await Tab.open(browser);
  // Counts the tones: nobody listens to a headless browser.
  await tab.context.addInitScript(() => {
    window.tones = 0;
    const start = OscillatorNode.prototype.start;
    OscillatorNode.prototype.start = function (...when) {
      ++window.tones;
      return start.apply(this, when);
    };
  });
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

const alert = () => tab.page.getByRole("alert");

test("an alarm is raised on the view that is open", async () => {
  const { page } = tab;
  await tab.visit(rig.url, "#/run");
  await page.getByRole("switch", { name: /sound/i }).first().check();
  await rig.command("start");
  await rig.reaches("two layers", ({ committed }) => committed >= 2);
  await page.goto(`${rig.url}/#/layers`);
  await page.locator('main[data-view="layers"]').waitFor();
  assert.equal(await alert().count(), 0);
  const tones = await page.evaluate(() => window.tones);
  rig.hand("press", "estop");
  await alert().waitFor();

  const { alarm } = await rig.reaches("alarm", (status) => status.alarm);
  const words = await alert().textContent();
  assert.ok(words.includes(alarm.cause), words);
  assert.ok(alarm.advice.length > 20 && words.includes(alarm.advice), words);
  assert.match(await page.title(), /ALARM/);
  await until("a sound", () => page.evaluate((before) => window.tones > before, tones));
});

test("it cannot be overlooked on any view", async () => {
  const { page } = tab;
  for (const view of ["run", "layers", "explorer"]) {
    await page.goto(`${rig.url}/#/${view}`);
    await page.locator(`main[data-view="${view}"]`).waitFor();
    const bar = await page.getByRole("region", { name: "Alarm" }).boundingBox();
    assert.ok(bar.width >= screen.width - 20, `${view}: ${bar.width} px wide`);
    assert.ok(bar.y >= 0 && bar.y + bar.height <= screen.height, `${view}: not on the screen`);
    assert.ok(bar.height >= 48, `${view}: ${bar.height} px high`);
  }
});

test("while the e-stop is pressed there is nothing to acknowledge, and a command is refused", async () => {
  await alert().waitFor();
  const offered = tab.page.getByRole("button", { name: /^Acknowledge/ });
  assert.equal(await offered.count(), 0);
  await assert.rejects(rig.command("acknowledge"), /e-?stop/i);
});

test("once it is released the alarm is acknowledged, with a reason that goes into the journal", async () => {
  const { page } = tab;
  rig.hand("release", "estop");
  await rig.reaches("released", ({ interlocks }) => !interlocks.lines.estop_pressed);
  const sentence = await command(page, "Acknowledge", {
    token: rig.token,
    reason: "a sleeve caught it",
  });
  assert.match(sentence, /^Done: /);
  await alert().waitFor({ state: "detached" });
  assert.doesNotMatch(await page.title(), /ALARM/);
  assert.match(rig.log, /acknowledge by .*\(a sleeve caught it\)/);
});

test("a run is aborted only after the word was typed", async () => {
  const { page } = tab;
  await page.goto(`${rig.url}/#/run`);
  await page.getByRole("button", { name: /^Abort…?$/ }).click();
  const asked = page.getByRole("dialog", { name: "Abort" });
  const abort = asked.getByRole("button", { name: "Abort", exact: true });
  assert.ok(await abort.isDisabled());
  await asked.getByLabel(/to confirm/).fill("abort");
  assert.ok(await abort.isEnabled());
  await page.keyboard.press("Escape");
  await asked.waitFor({ state: "hidden" });
  assert.equal((await rig.status()).state, "paused");
});

test("the run is resumed from the page and ends whole", async () => {
  const { page } = tab;
  await page.goto(`${rig.url}/#/run`);
  await command(page, "Resume");
  await page.locator('header [data-state="done"]').waitFor({ timeout: 240_000 });
  assert.equal((await rig.status()).committed, rig.layers);
});

test("nothing failed and nothing was complained of", () => tab.assertNoFaults([askedForToken]));
