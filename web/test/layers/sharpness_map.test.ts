import { describe, expect, it } from "vitest";

import type { Sharpness } from "../../src/api/types";
import {
  changeMap,
  changeRange,
  mapTile,
  partOf,
  shownRange,
  tileAt,
} from "../../src/layers/sharpness_map";

function mapOf(values: (number | null)[], columns: number): Sharpness {
  const rows = values.length / columns;
  return { layer: 1, columns, rows, tile_width: 100, tile_height: 50, measure: "", values };
}

describe("the range of the colour scale", () => {
  it("does not follow one odd tile in twenty", () => {
    const values = Array.from({ length: 41 }, (_, index) => index / 40);
    values[40] = 1000;
    const range = shownRange(mapOf(values, 41));
    expect(range).toEqual({ low: 2 / 40, high: 38 / 40 });
  });

  it("leaves out tiles without a value", () => {
    expect(shownRange(mapOf([null, 2, 4, null], 2))).toEqual({ low: 2, high: 4 });
  });

  it("is none where no tile has a value", () => {
    expect(shownRange(mapOf([null, null], 2))).toBeNull();
  });
});

describe("a value", () => {
  it("stands between the ends of the scale", () => {
    const range = { low: 2, high: 4 };
    expect([1, 2, 3, 4, 9].map((value) => partOf(value, range))).toEqual([0, 0, 0.5, 1, 1]);
  });

  it("stands in the middle when all are alike", () => {
    expect(partOf(3, { low: 3, high: 3 })).toBe(0.5);
  });
});

describe("the change from the layer before", () => {
  it("is a quotient, tile by tile", () => {
    const change = changeMap(mapOf([1, 3, null, 4], 2), mapOf([2, 2, 2, null], 2));
    expect(change.values).toEqual([0.5, 1.5, null, null]);
    expect(change.columns).toBe(2);
  });

  it("is in the middle of the scale where nothing changed", () => {
    expect(partOf(1, changeRange)).toBe(0.5);
  });

  it("is unknown where there was no detail, or the tiles were others", () => {
    expect(changeMap(mapOf([1, 1], 2), mapOf([0, -0.1], 2)).values).toEqual([null, null]);
    expect(changeMap(mapOf([1, 1], 2), mapOf([1, 1], 1)).values).toEqual([null, null]);
  });
});

describe("a tile", () => {
  const map = mapOf([1, 2, 3, 4, 5, 6], 3);

  it("is found under a place", () => {
    expect(tileAt(map, { x: 0, y: 0 })).toBe(0);
    expect(tileAt(map, { x: 299.9, y: 50 })).toBe(5);
  });

  it("is none beside the picture", () => {
    expect(tileAt(map, { x: -0.1, y: 10 })).toBeNull();
    expect(tileAt(map, { x: 300, y: 10 })).toBeNull();
    expect(tileAt(map, { x: 10, y: 100 })).toBeNull();
  });

  it("covers its part of the picture", () => {
    expect(mapTile(map, 4)).toEqual({ left: 100, top: 50, right: 200, bottom: 100 });
  });
});
