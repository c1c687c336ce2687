// axe-core on each view, by day and by night, at rest and with an alarm.
import assert from "node:assert/strict";
import fs from "node:fs";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { Rig } from "./rig.mjs";
import { rejectionsAtLayer4 } from "./scenarios.mjs";
import { open, views } from "./views.mjs";

const axe = fs.readFileSync(new URL(import.meta.resolve("axe-core/axe.min.js")), "utf8");
const rules = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];

let rig;
let browser;

before(async () => {
  rig = await Rig.start({ layers: 6, scenario: rejectionsAtLayer4 });
  await rig.runJob();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

/** What axe finds of weight, with the elements where. */
async function findings(page) {
  // The policy forbids scripts of others: the browser's own debugger may run one all the same.
  await page.evaluate(axe);
  const { violations, passes } = await page.evaluate(
    (tags) => window.axe.run(document, { runOnly: { type: "tag", values: tags } }),
    rules,
  );
  assert.ok(passes.length > 10, "next to nothing was looked at");
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .map(
      ({ id, help, nodes }) =>
        `${id}: ${help}: ${nodes.map(({ html, any }) => `${html.slice(0, 160)} ${any[0]?.message ?? ""}`).join(" | ")}`,
    );
}

for (const colorScheme of ["light", "dark"]) {
  for (const view of views) {
    test(`${view.name}, ${colorScheme}`, async () => {
      const tab = await Tab.open(browser, { colorScheme });
      try {
        await open(tab, rig.url, view);
        assert.deepEqual(await findings(tab.page), []);
        tab.assertNoFaults();
      } finally {
        await tab.close();
      }
    });
  }
}

test("dialogs, light and dark", async () => {
  for (const colorScheme of ["light", "dark"]) {
    const tab = await Tab.open(browser, { colorScheme });
    try {
      const { page } = tab;
      await open(tab, rig.url, views[0]);
      await page.getByText("Calibrate the camera").click();
      await page.getByRole("button", { name: "Find the focus" }).click();
      await page.getByRole("dialog", { name: "Find the focus" }).waitFor();
      assert.deepEqual(await findings(page), []);
      await page.keyboard.press("Escape");
      await open(tab, rig.url, views[2]);
      await page
        .getByRole("button", { name: /^Export/ })
        .first()
        .click();
      await page.getByRole("dialog").waitFor();
      assert.deepEqual(await findings(page), []);
    } finally {
      await tab.close();
    }
  }
});

test("an alarm, light and dark", async () => {
  const stopped = await Rig.start({ layers: 6, timeScale: 60 });
  try {
    await stopped.command("start");
    await stopped.reaches("a layer", ({ committed }) => committed >= 1);
    stopped.hand("press", "estop");
    await stopped.reaches("an alarm", ({ alarm }) => alarm);
    for (const colorScheme of ["light", "dark"]) {
      const tab = await Tab.open(browser, { colorScheme });
      await tab.visit(stopped.url, "#/run");
      await tab.page.getByRole("alert").waitFor();
      assert.deepEqual(await findings(tab.page), []);
      await tab.close();
    }
  } finally {
    await stopped.stop();
  }
});
