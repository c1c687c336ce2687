import { describe, expect, it } from "vitest";

import { highestMarked, marksWith, noMarks } from "../../src/layers/layer_marks";

const attempts = [
  { id: 1, layer: 1, verdict: "accepted" },
  { id: 2, layer: 2, verdict: "rejected" },
  { id: 3, layer: 2, verdict: "rejected" },
  { id: 4, layer: 2, verdict: "accepted_with_flag" },
  { id: 5, layer: 3, verdict: "not_stored" },
];

describe("marks", () => {
  it("count rejected attempts and tell flagged layers", () => {
    const marks = marksWith(noMarks, attempts);
    expect(marks.byLayer.get(1)).toEqual({ rejected: 0, flagged: false, accepted: true });
    expect(marks.byLayer.get(2)).toEqual({ rejected: 2, flagged: true, accepted: true });
    expect(marks.byLayer.get(3)).toEqual({ rejected: 0, flagged: false, accepted: false });
    expect(highestMarked(marks)).toBe(3);
  });

  it("count an attempt once that is told again", () => {
    const marks = marksWith(noMarks, attempts);
    expect(marksWith(marks, attempts.slice(1))).toBe(marks);
  });

  it("come out the same when the history is told after an attempt that followed it", () => {
    const late = marksWith(marksWith(noMarks, attempts.slice(3)), attempts);
    expect(late.byLayer).toEqual(marksWith(noMarks, attempts).byLayer);
  });

  it("leave those that they grew from as they were", () => {
    const before = marksWith(noMarks, attempts.slice(0, 2));
    marksWith(before, attempts);
    expect(before.byLayer.get(2)?.rejected).toBe(1);
  });

  it("have no highest layer while there is none", () => {
    expect(highestMarked(noMarks)).toBe(0);
  });
});
