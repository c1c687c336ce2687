// Two people look at one rig; one of them has the token.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { askedForToken, command, dialog, sendCommand } from "./operator.mjs";
import { Rig } from "./rig.mjs";

let rig;
let browsers;
let operator;
let visitor;

before(async () => {
  rig = await Rig.start({ layers: 12, timeScale: 60 });
  browsers = await Promise.all([launch(), launch()]);
  [operator, visitor] = await Promise.all(browsers.map((browser) => Tab.open(browser)));
});
after(async () => {
  await Promise.all((browsers ?? []).map((browser) => browser.close()));
  await rig?.stop();
});

const shows = (tab, state) => tab.page.locator(`header [data-state="${state}"]`).waitFor();

test("both see what one of them commands", async () => {
  await Promise.all([operator.visit(rig.url, "#/run"), visitor.visit(rig.url, "#/run")]);
  await command(operator.page, "Start", { token: rig.token });
  await rig.reaches("a layer", ({ committed }) => committed >= 1);
  await command(operator.page, "Pause");
  await Promise.all([shows(operator, "paused"), shows(visitor, "paused")]);
});

test("who has no token is asked for one, and commands nothing", async () => {
  const { page } = visitor;
  const asked = await sendCommand(page, "Resume");
  const token = dialog(page, "Token needed");
  await token.waitFor();
  await page.keyboard.press("Escape");
  await token.waitFor({ state: "hidden" });
  await asked.locator(".notice-bad").waitFor();
  await page.keyboard.press("Escape");
  await asked.waitFor({ state: "hidden" });
  assert.equal((await rig.status()).state, "paused");
});

test("both see the end, each where they are", async () => {
  await visitor.page.goto(`${rig.url}/#/layers`);
  await command(operator.page, "Resume");
  await Promise.all([shows(operator, "done"), shows(visitor, "done")]);
  await visitor.page.locator(`[data-layer="${rig.layers}"]`).first().waitFor();
});

test("neither complained", () => {
  operator.assertNoFaults([askedForToken]);
  visitor.assertNoFaults([askedForToken]);
  visitor.assertKeptTo(rig.url, rig.token);
});
