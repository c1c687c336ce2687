import { expect, it } from "vitest";

import { cssColour, scaleColour, type Rgb } from "../../src/layers/colour_scale";

/** Relative luminance as WCAG defines it. */
function luminance(colour: Rgb): number {
  const [r, g, b] = colour.map((channel) => {
    const part = channel / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

it("grows lighter from end to end, so that it can be read without colours", () => {
  for (let step = 1; step <= 100; step += 1) {
    const darker = luminance(scaleColour((step - 1) / 100));
    expect(luminance(scaleColour(step / 100))).toBeGreaterThanOrEqual(darker);
  }
  expect(luminance(scaleColour(1)) - luminance(scaleColour(0))).toBeGreaterThan(0.7);
});

it("goes from blue to yellow, which all eyes tell apart", () => {
  const [lowRed, , lowBlue] = scaleColour(0);
  const [highRed, , highBlue] = scaleColour(1);
  expect(lowBlue).toBeGreaterThan(lowRed);
  expect(highRed).toBeGreaterThan(highBlue);
});

it("holds values beyond its ends", () => {
  expect(scaleColour(-1)).toEqual(scaleColour(0));
  expect(scaleColour(2)).toEqual(scaleColour(1));
});

it("is written for CSS", () => {
  expect(cssColour([1, 2, 3])).toBe("rgb(1 2 3)");
});
