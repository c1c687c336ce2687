import { expect, it } from "vitest";

import { slugWords, verdictWords } from "./verdict_words";

it.each([
  ["accepted", "Accepted", "good"],
  ["accepted_with_flag", "Accepted with a flag", "flagged"],
  ["rejected", "Rejected", "rejected"],
  ["not_stored", "Good, but not stored", "lost"],
])('%s is "%s", marked %s', (verdict, title, mark) => {
  expect(verdictWords(verdict)).toEqual({ title, mark });
});

it("reads a slug as words", () => {
  expect(slugWords("face-unchanged")).toBe("face unchanged");
});
