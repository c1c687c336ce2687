import { describe, expect, it } from "vitest";

import { marksWith, noMarks } from "../../src/layers/layer_marks";
import { allLayers, filteredLayers, someLayers } from "../../src/layers/layer_sequence";

describe("all layers", () => {
  it("are numbered from 1", () => {
    const layers = allLayers(10);
    expect(layers.at(0)).toBe(1);
    expect(layers.nearest(10)).toBe(9);
  });

  it("hold a number beyond them to their ends", () => {
    expect(allLayers(10).nearest(99)).toBe(9);
    expect(allLayers(10).nearest(0)).toBe(0);
    expect(allLayers(0).nearest(5)).toBe(-1);
  });
});

describe("some layers", () => {
  it("are found by the nearest number, the earlier of two on a tie", () => {
    const layers = someLayers([3, 10, 40]);
    expect([1, 3, 6, 7, 24, 26, 99].map((layer) => layers.nearest(layer))).toEqual([
      0, 0, 0, 1, 1, 2, 2,
    ]);
    expect(someLayers([1, 3]).nearest(2)).toBe(1);
    expect(someLayers([]).nearest(2)).toBe(-1);
  });
});

describe("a filter", () => {
  const marks = marksWith(noMarks, [
    { id: 1, layer: 7, verdict: "rejected" },
    { id: 2, layer: 7, verdict: "accepted" },
    { id: 3, layer: 4, verdict: "accepted_with_flag" },
    { id: 4, layer: 2, verdict: "rejected" },
    { id: 5, layer: 2, verdict: "accepted_with_flag" },
  ]);
  const layers = (filter: "all" | "rejected" | "flagged", highest: number) => {
    const sequence = filteredLayers(filter, marks, highest);
    return Array.from({ length: sequence.count }, (_, index) => sequence.at(index));
  };

  it("leaves the layers with a rejected attempt, or with a flag, in order", () => {
    expect(layers("rejected", 9)).toEqual([2, 7]);
    expect(layers("flagged", 9)).toEqual([2, 4]);
    expect(layers("all", 3)).toEqual([1, 2, 3]);
  });

  it("shows no layer above the highest", () => {
    expect(layers("rejected", 6)).toEqual([2]);
  });
});
