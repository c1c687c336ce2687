import { expect, it } from "vitest";

import { askedBy } from "../../src/explorer/command_words";

it("says what tells one command from another", () => {
  const section =
    "biotomy section '/data/the knee' --points='0,0,0 9,0,0 9,9,1' --pixel=20 --output=section.png";
  expect(askedBy(section)).toBe("--points='0,0,0 9,0,0 9,9,1' --pixel=20");
  const series = "biotomy series '/data/Ann'\\''s' rotate --axis=x --step=3 --output=series";
  expect(askedBy(series)).toBe("rotate --axis=x --step=3");
  expect(askedBy("")).toBe("");
});
