import { describe, expect, it } from "vitest";

import { TiledLayer, WholePicture, type BitmapLoader } from "../../src/layers/picture_source";

const face = { width: 3000, height: 2000 };
const all = { left: 0, top: 0, right: 3000, bottom: 2000 };
const tile = (name: string) => `/api/v1/layers/7/tiles/${name}`;

/** Bitmaps of 512 pixels under the addresses that are there. */
function loaderWith(...addresses: string[]): BitmapLoader {
  const bitmap = { width: 512, height: 512 };
  return {
    picture: (address: string) => (addresses.includes(address) ? bitmap : undefined),
  } as unknown as BitmapLoader;
}

describe("a layer in tiles", () => {
  const layer = new TiledLayer(7, face);

  it("asks for the whole picture first, small, then for the tiles in sight", () => {
    const corner = { left: 0, top: 0, right: 600, bottom: 400 };
    expect(layer.addresses(corner, 1)).toEqual([tile("3/0/0"), tile("0/0/0"), tile("0/1/0")]);
  });

  it("asks once for a tile that is the whole picture", () => {
    expect(layer.addresses(all, 0.1)).toEqual([tile("3/0/0")]);
  });

  it("paints coarse tiles below the fine ones that are missing", () => {
    const loader = loaderWith(tile("3/0/0"), tile("1/0/0"), tile("0/1/0"));
    const seen = { left: 0, top: 0, right: 600, bottom: 400 };
    expect(layer.pieces(seen, 1, loader).map(({ reduced }) => reduced)).toEqual([2, 1]);
    const elsewhere = { left: 1024, top: 0, right: 1500, bottom: 400 };
    expect(layer.pieces(elsewhere, 1, loader).map(({ reduced }) => reduced)).toEqual([8]);
  });

  it("paints nothing below what is complete", () => {
    const loader = loaderWith(tile("3/0/0"), tile("0/0/0"));
    const seen = { left: 0, top: 0, right: 500, bottom: 400 };
    expect(layer.pieces(seen, 1, loader)).toHaveLength(1);
  });

  it("puts a tile where its pixels are", () => {
    const loader = loaderWith(tile("1/1/1"));
    const seen = { left: 1100, top: 1100, right: 1200, bottom: 1200 };
    expect(layer.pieces(seen, 0.5, loader)[0].covers).toEqual({
      left: 1024,
      top: 1024,
      right: 2048,
      bottom: 2048,
    });
  });

  it("knows its whole picture when it is there", () => {
    expect(layer.whole(loaderWith())).toBeNull();
    expect(layer.whole(loaderWith(tile("3/0/0")))?.reduced).toBe(8);
  });
});

it("stretches a small picture of a frame over the whole face", () => {
  const frame = new WholePicture("/api/v1/rejected/x.jpg", face);
  const [piece] = frame.pieces(all, 1, loaderWith("/api/v1/rejected/x.jpg"));
  expect(piece.covers).toEqual(all);
  expect(piece.reduced).toBeCloseTo(3000 / 512, 9);
  expect(frame.pieces(all, 1, loaderWith())).toEqual([]);
  expect(frame.reduction(loaderWith("/api/v1/rejected/x.jpg"))).toBeCloseTo(3000 / 512, 9);
  expect(frame.reduction(loaderWith())).toBe(1);
});
