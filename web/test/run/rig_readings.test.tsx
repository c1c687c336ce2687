// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it } from "vitest";

import type { StageStatus } from "../../src/api/types";
import { RigReadings } from "../../src/run/RigReadings";
import { aStatus } from "../a_status";

const page = document.createElement("div");
afterEach(() => render(null, page));

const stage: StageStatus = {
  answers: true,
  controller_state: "ready",
  positions_um: { feed: 1, traverse: 2, column: 612.34, ground_to: 3 },
  grind_count: 0,
  spindle: { rpm: 3000, load_percent: 97 },
  vibration_mm_s: 1.5,
  temperatures_c: { block: -3, chamber: -20 },
};
const limits = { block_temperature_c: [-80, -5], spindle_load_percent: [null, 95] } as never;

const readings = () =>
  new Map(
    [...page.querySelectorAll<HTMLElement>(".reading")].map((reading) => [
      reading.querySelector("dt")!.textContent,
      [reading.dataset.fit, reading.querySelector("dd")!.textContent!.replaceAll("\u00a0", " ")],
    ]),
  );

it("tells what each instrument shows, its limits, and what is beyond them", async () => {
  await act(() => render(<RigReadings status={aStatus({ stage, limits })} />, page));
  expect(readings().get("Block temperature")).toEqual(["high", "−3.0 °C too warm−80 to −5 °C"]);
  expect(readings().get("Spindle load")).toEqual(["high", "97 % too muchat most 95 %"]);
  expect(readings().get("Chamber temperature")).toEqual(["good", "−20.0 °C"]);
  expect(readings().get("Column (camera)")).toEqual(["good", "612.3 µm"]);
  expect(readings().size).toBe(9);
});

it("says that a silent controller's words are old, and that there are none yet", async () => {
  const silent = { ...stage, answers: false };
  await act(() => render(<RigReadings status={aStatus({ stage: silent })} />, page));
  expect(page.textContent).toContain("what it said last");
  await act(() => render(<RigReadings status={aStatus({})} />, page));
  expect(page.textContent).toContain("has not answered yet");
});
