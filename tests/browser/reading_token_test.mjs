// A rig whose page shows nothing to whoever has no token.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { sharpSection } from "./explorer.mjs";
import { askedForToken, dialog, giveToken, wrongToken } from "./operator.mjs";
import { Rig } from "./rig.mjs";

let rig;
let browser;
let tab;

before(async () => {
  rig = await Rig.start({ layers: 4, service: 'read = "token"\n' });
  await rig.runJob();
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

test("the page asks for the token, and again when it is wrong", async () => {
  const { page } = tab;
  await page.goto(rig.url);
  const asked = dialog(page, "Token needed");
  await asked.getByLabel("Token").fill("wrong-0123456789abcdef");
  await asked.getByRole("button", { name: "Use this token" }).click();
  await dialog(page, "Token needed")
    .getByText(/not accepted/)
    .waitFor();
  await giveToken(page, rig.token);
  await page.locator('main[data-view="run"] [data-chart]').first().waitFor();
  await tab.isLive();
});

test("every view has its pictures, with the token in the header alone", async () => {
  const { page } = tab;
  await page.goto(`${rig.url}/#/layers/3`);
  await page.locator('canvas[data-role="layer"][data-layer="3"][data-state="sharp"]').waitFor();
  await page.locator('[data-role="strip"] img').first().waitFor();
  await page.goto(`${rig.url}/#/explorer`);
  await sharpSection(page);
  const asked = tab.requests.filter(({ url }) => /\/api\/v1\/(layers|section|events)/.test(url));
  assert.ok(asked.length > 5);
  tab.assertKeptTo(rig.url, rig.token);
});

test("the tab remembers it when it is loaded anew, another tab does not", async () => {
  const { page } = tab;
  await page.reload();
  await sharpSection(page);
  assert.equal(await dialog(page, "Token needed").count(), 0);
  const other = await tab.context.newPage();
  await other.goto(rig.url);
  await dialog(other, "Token needed").waitFor();
  await other.close();
});

test("nothing else was complained of", () => tab.assertNoFaults([askedForToken, wrongToken]));
