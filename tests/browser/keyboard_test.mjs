// Everything by the keyboard alone: a run is started, a layer is looked for, the plane is moved.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { sharpSection } from "./explorer.mjs";
import { askedForToken } from "./operator.mjs";
import { Rig } from "./rig.mjs";
import { until } from "./until.mjs";

let rig;
let browser;
let tab;

before(async () => {
  rig = await Rig.start({ layers: 6 });
  browser = await launch();
  tab = await Tab.open(browser);
  // Whoever has the mouse has it far away.
  tab.page.mouse.move = tab.page.mouse.down = () => assert.fail("the mouse was used");
});
after(async () => {
  await browser?.close();
  await rig?.stop();
});

/** Where the focus is: what it is called, and whether a person sees that it is there. */
const focus = (page) =>
  page.evaluate(() => {
    const element = document.activeElement;
    const style = getComputedStyle(element);
    const outlined = style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1;
    return {
      name: (element.getAttribute("aria-label") ?? element.textContent).trim(),
      role: element.dataset.role ?? "",
      tag: element.tagName,
      seen: element === document.body || outlined || style.boxShadow !== "none",
      what: element.outerHTML.slice(0, 160),
    };
  });

/** Presses `key` until the focus is on what `wanted` accepts; each stop on the way must be seen. */
async function tabTo(wanted, key = "Tab") {
  const { page } = tab;
  const mostStops = 120;
  const stops = [];
  for (let stop = 0; stop < mostStops; ++stop) {
    await page.keyboard.press(key);
    const at = await focus(page);
    stops.push(at.name || at.role || at.what);
    assert.ok(at.seen, `the focus is not to be seen on ${at.what}`);
    if (wanted(at)) return at;
  }
  return assert.fail(`not reached by ${key}: ${stops.join(", ")}`);
}

test("the first stop leads past the head of the page", async () => {
  await tab.visit(rig.url, "#/run");
  const { page } = tab;
  await page.keyboard.press("Tab");
  assert.match((await focus(page)).name, /^Skip/);
  await page.keyboard.press("Enter");
  await until("the content", () => page.evaluate(() => document.activeElement.id === "main"));
});

test("Escape closes a dialog and gives the focus back", async () => {
  const { page } = tab;
  await tabTo(({ name, tag }) => tag === "BUTTON" && /^Start…?$/.test(name));
  await page.keyboard.press("Enter");
  const asked = page.getByRole("dialog", { name: "Start" });
  await asked.waitFor();
  await page.keyboard.press("Escape");
  await asked.waitFor({ state: "hidden" });
  assert.match((await focus(page)).name, /^Start…?$/);
});

test("the focus stays in a dialog, and a run is started in it", async () => {
  const { page } = tab;
  await page.keyboard.press("Enter");
  const asked = page.getByRole("dialog", { name: "Start" });
  await asked.waitFor();
  for (let stop = 0; stop < 8; ++stop) {
    await page.keyboard.press("Tab");
    const inside = await page.evaluate(
      () =>
        document.activeElement === document.body ||
        document.activeElement.closest("dialog") !== null,
    );
    assert.ok(inside, (await focus(page)).what);
  }
  await asked.getByLabel("Reason").focus();
  await page.keyboard.type("by the keys");
  await page.keyboard.press("Enter");
  await page.getByRole("dialog", { name: "Token needed" }).waitFor();
  await page.keyboard.type(rig.token);
  await page.keyboard.press("Enter");
  await asked.getByRole("status").waitFor();
  await page.keyboard.press("Escape");
  await asked.waitFor({ state: "hidden" });
  await page.locator('header [data-state="done"]').waitFor({ timeout: 240_000 });
  assert.match(rig.log, /start by .*\(by the keys\)/);
});

test("a dialog stays while its command is on its way, however often Escape is pressed", async () => {
  const { page } = tab;
  const command = "**/api/v1/control/calibrate-focus";
  let answer;
  const held = new Promise((resolve) => (answer = resolve));
  await page.route(command, async (route) => {
    await held;
    await route.fulfill({ json: { accepted: true, message: "it was kept waiting" } });
  });
  await tabTo(({ name, tag }) => tag === "SUMMARY" && name === "Calibrate the camera");
  await page.keyboard.press("Enter");
  await tabTo(({ name, tag }) => tag === "BUTTON" && name === "Find the focus");
  await page.keyboard.press("Enter");
  const asked = page.getByRole("dialog", { name: "Find the focus" });
  await asked.getByLabel("Reason").focus();
  await page.keyboard.press("Enter");
  await asked.getByText("Asking…").waitFor();
  for (let times = 0; times < 3; ++times) await page.keyboard.press("Escape");
  await asked.getByText("Asking…").waitFor();
  answer();
  await asked.getByText("it was kept waiting").waitFor();
  await page.keyboard.press("Escape");
  await asked.waitFor({ state: "hidden" });
  await page.unroute(command);
});

test("layers are gone through", async () => {
  const { page } = tab;
  await tabTo(({ name, tag }) => tag === "A" && name === "Layers", "Shift+Tab");
  await page.keyboard.press("Enter");
  await page.locator('[data-role="strip"]').waitFor();
  await tabTo(({ role }) => role === "strip");
  await page.keyboard.press("Home");
  await page.waitForURL(/#\/layers\/1(\D|$)/);
  await page.keyboard.press("ArrowRight");
  await page.waitForURL(/#\/layers\/2(\D|$)/);
});

test("the plane is moved", async () => {
  const { page } = tab;
  await tabTo(({ name, tag }) => tag === "A" && name === "Explorer", "Shift+Tab");
  await page.keyboard.press("Enter");
  const canvas = await sharpSection(page);
  const command = await canvas.getAttribute("data-command");
  await tabTo(({ role }) => role === "cuboid");
  await page.keyboard.press("PageDown");
  await page.keyboard.press("ArrowUp");
  await sharpSection(page, command);
});

test("the export's dialog is opened and closed", async () => {
  const { page } = tab;
  await tabTo(({ name, tag }) => tag === "BUTTON" && /^Export/.test(name));
  await page.keyboard.press("Enter");
  const dialog = page.getByRole("dialog", { name: /export/i });
  await dialog.waitFor();
  await page.keyboard.press("Escape");
  await dialog.waitFor({ state: "hidden" });
  assert.match((await focus(page)).name, /^Export/);
});

test("nothing failed and nothing was complained of", () => tab.assertNoFaults([askedForToken]));
