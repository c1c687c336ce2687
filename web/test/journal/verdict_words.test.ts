import { expect, it } from "vitest";

import { slugWords, verdictWords } from "../../src/journal/verdict_words";

it.each([
  ["accepted", "Accepted", "good", true],
  ["accepted_with_flag", "Accepted with a flag", "flagged", true],
  ["rejected", "Rejected", "rejected", false],
  ["not_stored", "Good, but not stored", "lost", false],
])('%s is "%s", marked %s', (verdict, title, mark, accepted) => {
  expect(verdictWords(verdict)).toEqual({ title, mark, accepted });
});

it("reads a slug as words", () => {
  expect(slugWords("face-unchanged")).toBe("face unchanged");
});
