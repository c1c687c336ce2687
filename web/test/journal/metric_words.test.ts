import { expect, it } from "vitest";

import { limitText, metricOrder, metricWords, valueText } from "../../src/journal/metric_words";

it.each([
  ["sharpness_ratio", 0.98765, 0.96, "0.988", "≥ 0.960"],
  ["debris", 0.00123, 0.0025, "0.12 %", "≤ 0.25 %"],
  ["shift_x", -1.234, 3, "−1.23 px", "± 3.00 px"],
  ["brightness", -0.0512, 0.05, "−5.12 %", "± 5.00 %"],
  ["brightness", -0.0000001, 0.05, "−0.00001 %", "± 5.00 %"],
  ["shift_y", -0.001, 3, "0.00 px", "± 3.00 px"],
  ["brightness_minimum", 0.498657, 0.05, "49.9 %", "≥ 5.00 %"],
  ["casting_red", 0.195, 1, "19.5 %", "none"],
  ["noise_fine_light", 0.0000083, 1, "0.0000083", "none"],
  ["old_part", 0, 0, "0 %", "≤ 0 %"],
  ["a_new_metric", 1.5, 2, "1.500", "2.000"],
])("%s of %f with the limit %f: %s, %s", (name, value, limit, valueWords, limitWords) => {
  const words = metricWords(name);
  const plain = (text: string) => text.replaceAll("\u00a0", " ");
  expect(plain(valueText(value, words))).toBe(valueWords);
  expect(plain(limitText(limit, words))).toBe(limitWords);
});

it("shows what is missing as a dash", () => {
  expect(valueText(null, metricWords("sharpness_ratio"))).toBe("–");
  expect(limitText(null, metricWords("sharpness_ratio"))).toBe("none");
});

it("puts sharpness first and what it does not know last", () => {
  const names = ["a_new_metric", "dead_rows", "sharpness_ratio", "frost"];
  expect(names.sort((a, b) => metricOrder(a) - metricOrder(b))).toEqual([
    "sharpness_ratio",
    "frost",
    "dead_rows",
    "a_new_metric",
  ]);
});

it("makes a title of a name that it does not know", () => {
  expect(metricWords("a_new_metric").title).toBe("A new metric");
});
