import { expect, it } from "vitest";

import { scaleBar } from "../../src/layers/scale_bar";

it.each([
  [1, 120, 100, "100\u00a0µm"],
  [1, 100, 100, "100\u00a0µm"],
  [1, 99, 50, "50\u00a0µm"],
  [0.5, 90, 20, "20\u00a0µm"],
  [25, 120, 2000, "2\u00a0mm"],
  [0.001, 120, 0.1, "0.1\u00a0µm"],
])('%f µm a pixel in %f pixels: a bar of %f µm, "%s"', (umPerPixel, widest, um, text) => {
  const bar = scaleBar(umPerPixel, widest);
  expect(bar.um).toBeCloseTo(um, 9);
  expect(bar.width).toBeCloseTo(um / umPerPixel, 6);
  expect(bar.text).toBe(text);
});
