// The plane is moved in every way there is; what is drawn beside it is what `biotomy section` cuts.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Tab, launch } from "./browser.mjs";
import { cuboid, dragHandle, drawnByTool, handles, section, sharpSection } from "./explorer.mjs";
import { assertSame, colours, pixelsOf } from "./pictures.mjs";
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

const commandOf = (page) => section(page).getAttribute("data-command");

/** The section on the page and the one that its command makes are one picture. */
async function assertDrawnAsByTool(before = "") {
  const canvas = await sharpSection(tab.page, before);
  const command = await canvas.getAttribute("data-command");
  const shown = await pixelsOf(canvas);
  assert.equal(await canvas.getAttribute("data-command"), command, "it changed while it was read");
  assertSame(shown, drawnByTool(command), command);
  assert.ok(colours(shown) > 100, `${command} shows nothing`);
  return command;
}

test("the first section is the tool's, pixel by pixel", async () => {
  await tab.visit(rig.url, "#/explorer");
  await assertDrawnAsByTool();
});

test("a point of the plane is dragged; there is a preview, then the sharpened section is the tool's", async () => {
  const { page } = tab;
  const before = await commandOf(page);
  const points = await handles(page);
  assert.equal(points.length, 3);
  await page.evaluate(() => {
    window.states = [];
    const canvas = document.querySelector('canvas[data-role="section"]');
    new MutationObserver(() => window.states.push(canvas.dataset.state)).observe(canvas, {
      attributes: true,
      attributeFilter: ["data-state"],
    });
  });
  await dragHandle(page, 0, 25, 40);
  await assertDrawnAsByTool(before);
  assert.ok((await page.evaluate(() => window.states)).includes("preview"), "there was no preview");
  assert.notDeepEqual(await handles(page), points);
});

for (const shortcut of ["Along layers", "x-z", "y-z", "Diagonal"]) {
  test(`the shortcut ${shortcut} gives the tool's section`, async () => {
    const before = await commandOf(tab.page);
    await tab.page
      .getByRole("button", { name: new RegExp(`^${shortcut}`, "i") })
      .first()
      .click();
    await assertDrawnAsByTool(before);
  });
}

/** A place on the edge that begins at a vertex of the outline that lies over this canvas. */
async function placeOnEdge(canvas, edge) {
  const outline = canvas.locator("xpath=..").locator("svg .section-outline");
  const vertices = (await outline.getAttribute("points"))
    .split(" ")
    .map((place) => place.split(",").map(Number));
  const [from, to] = [vertices[edge], vertices[(edge + 1) % vertices.length]];
  const box = await canvas.locator("xpath=..").boundingBox();
  return [box.x + from[0] + 0.4 * (to[0] - from[0]), box.y + from[1] + 0.4 * (to[1] - from[1])];
}

for (const [where, canvasOf, edge] of [
  ["section", section, 1],
  ["block", cuboid, 2],
]) {
  test(`a click on an edge in the ${where} chooses the rectangle on it, as the list does`, async () => {
    const { page } = tab;
    const list = page.getByLabel("Rectangle");
    const before = await commandOf(page);
    await page.mouse.click(...(await placeOnEdge(canvasOf(page), edge)));
    assert.equal(await list.inputValue(), `edge:${edge}`);
    const command = await assertDrawnAsByTool(before);
    assert.match(command, new RegExp(`--theta=edge:${edge}`));
    await list.selectOption("bounding");
    await sharpSection(page, command);
  });
}

test("the plane is turned by the keyboard in the cuboid, and the address follows", async () => {
  const { page } = tab;
  const before = await commandOf(page);
  const address = page.url();
  await cuboid(page).focus();
  await page.keyboard.press("PageDown");
  await assertDrawnAsByTool(before);
  await until("another address", () => page.url() !== address);
});

test("a rotation is played, and each frame is a section of its own", async () => {
  const { page } = tab;
  const player = page.getByRole("group", { name: "Player" });
  await player.getByRole("button", { name: "Play" }).click();
  const seen = new Set();
  await until(
    "five frames",
    async () => {
      seen.add(await commandOf(page));
      seen.add(await player.locator(".player-label").textContent());
      return seen.size > 6;
    },
    { said: () => [...seen].join("; ") },
  );
  await player.getByRole("button", { name: "Pause" }).click();
});

const planeOf = (page) =>
  Promise.all(
    [/^Tilt/, /^Azimuth/, /^(Offset|Depth)/].map((name) =>
      page.getByRole("spinbutton", { name }).inputValue(),
    ),
  );

test("a link and an export are of the frame's plane, not of the one it began from", async () => {
  const { page } = tab;
  assert.ok(await page.getByRole("button", { name: "Larger" }).isDisabled());
  await tab.context.grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.getByRole("button", { name: "Copy link" }).click();
  await page.getByRole("button", { name: "Copied" }).waitFor();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  const other = await Tab.open(browser);
  try {
    await other.page.goto(link);
    await sharpSection(other.page);
    const [shown, opened] = await Promise.all([planeOf(page), planeOf(other.page)]);
    shown.forEach((value, i) =>
      assert.ok(Math.abs(value - opened[i]) < 0.02, `${opened} ${shown}`),
    );
  } finally {
    await other.close();
  }
  const asked = page.waitForRequest(/section\/outline/);
  await page.getByRole("button", { name: /^Export/ }).click();
  const outline = new URL((await asked).url()).searchParams;
  assert.equal(outline.get("through"), new URLSearchParams(link.split("?")[1]).get("through"));
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Back" }).click();
  await sharpSection(page);
});

test("the explorer comes back to its plane from another view", async () => {
  const { page } = tab;
  const diagonal = await commandOf(page);
  await page.getByRole("button", { name: "y-z" }).click();
  await sharpSection(page, diagonal);
  const before = await commandOf(page);
  await page.getByRole("link", { name: "Layers" }).click();
  await page.locator('main[data-view="layers"]').waitFor();
  await page.getByRole("link", { name: "Explorer" }).click();
  await sharpSection(page);
  assert.equal(await commandOf(page), before);
});

test("a distance is measured in micrometres", async () => {
  const { page } = tab;
  await page.getByRole("button", { name: "Measure" }).click();
  const box = await section(page).boundingBox();
  const y = box.y + box.height / 2;
  const [left, right] = [box.x + box.width / 4, box.x + (box.width * 3) / 4];
  await page.mouse.click(left, y);
  await page.mouse.click(right, y);
  const words = await page.locator('[data-role="distance"]').textContent();
  const [, number, unit] = /([\d.\s\u202f\u00a0]+)(µm|mm)/.exec(words);
  const told = Number(number.replace(/\s/g, "")) * (unit === "mm" ? 1000 : 1);
  // Where it was clicked, by the picture's own matrix.
  const pixel = await page.evaluate(
    async (command) => {
      const word = (name) => new RegExp(`--${name}=('[^']*'|\\S+)`).exec(command)?.[1];
      const query = new URLSearchParams();
      for (const name of ["points", "normal", "through", "pixel", "theta", "basis"]) {
        const value = word(name);
        if (value) query.set(name, value.replaceAll("'", ""));
      }
      return (await (await fetch(`/api/v1/section/outline?${query}`)).json()).pixel_um;
    },
    await commandOf(page),
  );
  const columns = await section(page).evaluate(({ width }) => width);
  const expected = ((right - left) / box.width) * columns * pixel;
  assert.ok(Math.abs(told - expected) < 2 * pixel + expected / 100, `${told} µm, not ${expected}`);
  await page.getByRole("button", { name: "Measure" }).click();
});

test("a link opens the same view in another browser", async () => {
  const command = await commandOf(tab.page);
  const other = await Tab.open(browser);
  try {
    await other.page.goto(tab.page.url());
    const canvas = await sharpSection(other.page);
    assert.equal(await canvas.getAttribute("data-command"), command);
    other.assertNoFaults();
  } finally {
    await other.close();
  }
});

test("the cursor's place is told in micrometres of the sample", async () => {
  const { page } = tab;
  const box = await section(page).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await until("a place", async () =>
    /µm/.test(await page.locator('[data-role="cursor"]').first().textContent()),
  );
});

test("nothing failed and nothing was complained of", () => {
  tab.assertNoFaults();
  tab.assertKeptTo(rig.url, rig.token);
});
