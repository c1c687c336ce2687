import { describe, expect, it } from "vitest";

import {
  coarsestLevel,
  levelFor,
  tileRectangle,
  tilesWithin,
  type Tile,
} from "../../src/layers/tile_pyramid";

const face = { width: 10000, height: 5000 };

function names(tiles: Tile[]): string[] {
  return tiles.map((tile) => `${tile.column},${tile.row}`);
}

describe("the coarsest level", () => {
  it("holds the whole picture in one tile", () => {
    expect(coarsestLevel({ width: 512, height: 512 })).toBe(0);
    expect(coarsestLevel({ width: 513, height: 1 })).toBe(1);
    expect(coarsestLevel({ width: 1, height: 1024 })).toBe(1);
    expect(coarsestLevel(face)).toBe(5);
  });
});

describe("the level for a scale", () => {
  it("has at least a pixel for each pixel of the screen", () => {
    expect(levelFor(1, face)).toBe(0);
    expect(levelFor(0.51, face)).toBe(0);
    expect(levelFor(0.5, face)).toBe(1);
    expect(levelFor(0.3, face)).toBe(1);
    expect(levelFor(0.25, face)).toBe(2);
  });

  it("takes a scale for a power of two that rounding moved off it", () => {
    expect(levelFor(0.25 * (1 + 1e-12), face)).toBe(2);
  });

  it("stays between full resolution and the coarsest level", () => {
    expect(levelFor(16, face)).toBe(0);
    expect(levelFor(0.0001, face)).toBe(5);
  });
});

describe("the tiles within what is seen", () => {
  it("are all that it touches and no more", () => {
    const tiles = tilesWithin({ left: 511, top: 512, right: 1025, bottom: 1024 }, 0, face);
    expect(names(tiles).sort()).toEqual(["0,1", "1,1", "2,1"]);
  });

  it("end at the edges of the picture", () => {
    const whole = { left: -1e6, top: -1e6, right: 1e6, bottom: 1e6 };
    expect(tilesWithin(whole, 0, face)).toHaveLength(20 * 10);
    expect(tilesWithin(whole, 3, face)).toHaveLength(3 * 2);
    expect(names(tilesWithin(whole, 5, face))).toEqual(["0,0"]);
  });

  it("are none beside the picture", () => {
    expect(tilesWithin({ left: -50, top: 0, right: 0, bottom: 50 }, 0, face)).toEqual([]);
    expect(tilesWithin({ left: 10000, top: 0, right: 10050, bottom: 50 }, 0, face)).toEqual([]);
  });

  it("come from the middle outwards", () => {
    const seen = { left: 0, top: 0, right: 5 * 512, bottom: 5 * 512 };
    const tiles = names(tilesWithin(seen, 0, face));
    expect(tiles[0]).toBe("2,2");
    expect(tiles.slice(-4).sort()).toEqual(["0,0", "0,4", "4,0", "4,4"]);
  });
});

describe("the rectangle of a tile", () => {
  it("is cut off at the edge of the picture", () => {
    expect(tileRectangle({ level: 0, column: 19, row: 9 }, face)).toEqual({
      left: 9728,
      top: 4608,
      right: 10000,
      bottom: 5000,
    });
  });

  it("grows with the level", () => {
    expect(tileRectangle({ level: 2, column: 1, row: 0 }, face)).toEqual({
      left: 2048,
      top: 0,
      right: 4096,
      bottom: 2048,
    });
  });
});
