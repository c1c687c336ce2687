import { expect, it } from "vitest";

import { lengthWords, roundLength } from "../../src/ui/lengths";

it.each([
  [730, 500],
  [0.3, 0.2],
  [1000, 1000],
  [999.9999999999, 1000],
  [999, 500],
])("the longest round length up to %d is %d", (longest, round) => {
  expect(roundLength(longest)).toBeCloseTo(round, 12);
});

it.each([
  [500, "500\u00a0µm"],
  [2500, "2.5\u00a0mm"],
  [0.2, "0.2\u00a0µm"],
  [0, "0\u00a0µm"],
])("%d micrometres are %s", (um, words) => {
  expect(lengthWords(um)).toBe(words);
});
