// A whole run is begun from the page and watched on it from start to end.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { askedForToken, command } from "./operator.mjs";
import { Rig } from "./rig.mjs";
import { rejectionsAtLayer4 } from "./scenarios.mjs";
import { until } from "./until.mjs";

let rig;
let browser;
let tab;

before(async () => {
  rig = await Rig.start({ layers: 8, timeScale: 60, scenario: rejectionsAtLayer4 });
  browser = await launch();
  tab = await Tab.open(browser);
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

test("a run is started, watched and seen to end", async () => {
  const { page } = tab;
  await tab.visit(rig.url, "#/run");
  const sentence = await command(page, "Start", { token: rig.token, reason: "good evening" });
  assert.match(sentence, /^Done: /);

  const states = new Set();
  let committed = 0;
  await until(
    "the end of the run on the page",
    async () => {
      const seen = await page.evaluate(() => ({
        state: document.querySelector("header [data-state]").dataset.state,
        headline: document.querySelector("h1").textContent,
        title: document.title,
        now: document.querySelector("main progress")?.value ?? 0,
      }));
      states.add(seen.state);
      assert.ok(seen.headline.length > 0);
      assert.ok(seen.now >= committed, `the progress went from ${committed} to ${seen.now}`);
      committed = seen.now;
      return seen.state === "done";
    },
    { seconds: 240, said: async () => `${await page.title()}, ${committed} layers` },
  );
  assert.equal(committed, rig.layers);
  assert.ok(states.has("grinding") && states.size > 2, [...states].join());
  await page.getByRole("heading", { level: 1, name: /done/i }).waitFor();
  assert.match(await page.title(), /^Done 8\/8/);
});

test("every attempt of the run is in the charts, without loading the page anew", async () => {
  const { attempts, rejected } = await attemptsOfRig();
  assert.ok(rejected > 0, "nothing was rejected: nothing is tested");
  for (const chart of ["sharpness_ratio", "brightness", "focus_change", "column_um"]) {
    const figure = tab.page.locator(`[data-chart="${chart}"]`);
    await until(
      `${attempts} attempts in the chart ${chart}`,
      async () => Number(await figure.getAttribute("data-count")) === attempts,
      { said: () => figure.getAttribute("data-count") },
    );
  }
});

test("a rejected attempt leads to its layer", async () => {
  const { page } = tab;
  await page.locator('main a[href^="#/layers/4"]').first().click();
  await page.locator('main[data-view="layers"]').waitFor();
  assert.match(page.url(), /#\/layers\/4/);
});

test("nothing is polled: one stream of events told it all", () => {
  const asked = (path) => tab.requests.filter(({ url }) => new URL(url).pathname === path).length;
  assert.equal(asked("/api/v1/status"), 0);
  assert.equal(asked("/api/v1/events"), 1);
});

test("the token is in the tab's memory and the header alone", async () => {
  const { token, url, log } = rig;
  assert.ok(tab.requests.some(({ headers }) => headers.authorization === `Bearer ${token}`));
  tab.assertKeptTo(url, token);
  assert.ok(!log.includes(token), "the token is in the daemon's log");
  assert.match(log, /start by .*\(good evening\)/);
  const kept = await tab.page.evaluate(() => ({
    cookies: document.cookie,
    local: JSON.stringify(localStorage),
    address: location.href,
  }));
  for (const place of Object.values(kept)) assert.ok(!place.includes(token));
  assert.equal(kept.cookies, "");
});

test("nothing failed and nothing was complained of", () => tab.assertNoFaults([askedForToken]));

async function attemptsOfRig() {
  const { verdict } = await (await rig.ask("/api/v1/history")).json();
  return { attempts: verdict.length, rejected: verdict.filter((v) => v === "rejected").length };
}
