import { describe, expect, it } from "vitest";

import type { PlaneRectangle } from "../../src/explorer/geometry/plane_rectangle";
import { inSample } from "../../src/explorer/geometry/plane_rectangle";
import {
  closeupWindow,
  evenPixel,
  fittingPixel,
  movedBy,
  pixelAt,
  placeAt,
  placementOf,
  readablePixel,
  visiblePart,
  wholeWindow,
  zoomedAt,
} from "../../src/explorer/section_window";

const basis = { p: [1, 0, 0], q: [0, 1, 0] } as const;
const frame: PlaneRectangle = { ...basis, origin: [0, 0, 100], width: 9990, height: 4990 };
const closeup = closeupWindow(frame, 800, 600, { middle: [5000, 2500, 0], pixel: 2 });

describe("the window on a section", () => {
  it("finds its pixels again", () => {
    const [x, y] = pixelAt(closeup, placeAt(closeup, 123, 456));
    expect(x).toBeCloseTo(123, 9);
    expect(y).toBeCloseTo(456, 9);
  });

  it("shows the whole frame as large as it fits", () => {
    expect(fittingPixel(frame, 1000, 1000)).toBe(10);
    const whole = wholeWindow(frame, 1000, 1000);
    expect(pixelAt(whole, [0, 0])[0]).toBeCloseTo(0.5, 9);
  });

  it("shows a small section by whole pixels for every two voxels", () => {
    expect(evenPixel(9.98, 10)).toBe(10);
    expect(evenPixel(6, 10)).toBe(20 / 3);
    expect(evenPixel(5, 10)).toBe(5);
    expect(evenPixel(12, 10)).toBe(12);
  });

  it("keeps what is under the cursor where it is when it zooms", () => {
    const before = placeAt(closeup, 200, 100);
    const zoomed = closeupWindow(frame, 800, 600, zoomedAt(closeup, 2, [200, 100], 10)!);
    const after = placeAt(zoomed, 200, 100);
    expect(after[0]).toBeCloseTo(before[0], 9);
    expect(after[1]).toBeCloseTo(before[1], 9);
    expect(zoomed.pixel).toBe(1);
  });

  it("shows all again when it is zoomed out far enough, and stops at the finest pixel", () => {
    expect(zoomedAt(closeup, 1e-6, [0, 0], 10)).toBeNull();
    expect(zoomedAt(closeup, 1e6, [0, 0], 12)!.pixel).toBe(0.5);
  });

  it("begins to zoom from a small section that is shown by whole pixels a voxel", () => {
    const small: PlaneRectangle = { ...frame, width: 990, height: 990 };
    const whole = wholeWindow(small, 140, 140, evenPixel(fittingPixel(small, 140, 140), 10));
    expect(whole.pixel).toBe(10);
    expect(zoomedAt(whole, 1.05, [70, 70], 10)!.pixel).toBeCloseTo(9.5238, 9);
  });

  it("shows a small section by a pixel a voxel, in the middle, and no smaller", () => {
    const small: PlaneRectangle = { ...frame, width: 990, height: 990 };
    const whole = wholeWindow(small, 400, 400, evenPixel(fittingPixel(small, 400, 400), 10));
    expect(whole.pixel).toBeLessThan(3);
    const plain = { middle: [495, 495, 100], pixel: 10 };
    expect(zoomedAt(whole, whole.pixel / 10, [10, 300], 10)).toEqual(plain);
    expect(zoomedAt(whole, 1e-6, [10, 300], 10)).toEqual(plain);
    const window = closeupWindow(small, 400, 400, zoomedAt(whole, 1e-6, [0, 0], 10)!);
    expect(zoomedAt(window, 10 / whole.pixel, [0, 0], 10)).toBeNull();
  });

  it("is moved no further than to the frame's edge", () => {
    expect(movedBy(closeup, 1e6, -1e6).middle).toEqual([9990, 0, 100]);
  });
});

describe("the part that is seen", () => {
  it("lies on the pixels of the whole frame and covers the window", () => {
    const part = visiblePart(closeup, 10, basis)!;
    expect(part.corner).toEqual([4200, 1900, 100]);
    expect(part.width).toBe(1600);
    expect(part.height).toBe(1200);
    expect(part.angle).toBe(0);
  });

  it("ends where the frame ends", () => {
    const corner = closeupWindow(frame, 800, 600, { middle: [9990, 4990, 0], pixel: 2 });
    const part = visiblePart(corner, 2, basis)!;
    expect(part.corner[0] + part.width).toBe(9990);
    expect(part.corner[1] + part.height).toBe(4990);
  });

  it("is none beside the frame", () => {
    const beside = closeupWindow(frame, 800, 600, { middle: [99990, 0, 0], pixel: 2 });
    expect(visiblePart(beside, 2, basis)).toBeNull();
  });

  it("put back into the window, its pixels are the screen's", () => {
    const odd = closeupWindow(frame, 801, 601, { middle: [5001.3, 2499.1, 0], pixel: 2 });
    const part = visiblePart(odd, 2, basis)!;
    const columns = part.width / 2 + 1;
    const rows = part.height / 2 + 1;
    const place = placementOf(odd, part.corner, 2, columns, rows);
    expect(place.width).toBe(columns);
    expect(place.left).toBeLessThanOrEqual(0);
    expect(place.left + place.width).toBeGreaterThanOrEqual(801);
    expect(Number.isInteger(place.left) && Number.isInteger(place.top)).toBe(true);
    // The place of a pixel is off by half a pixel of the screen at most.
    const [x] = pixelAt(odd, [part.corner[0] - frame.origin[0], 0]);
    expect(Math.abs(x - (place.left + 0.5))).toBeLessThanOrEqual(0.5);
  });

  it("enlarges a picture coarser than the screen", () => {
    const place = placementOf(closeup, inSample(frame, [4200, 1900]), 10, 161, 121);
    expect(place.width).toBe(805);
    expect(place.left).toBe(-2);
  });
});

describe("the size of a pixel", () => {
  it("has five digits, and is never above what was asked", () => {
    expect(readablePixel(12.345678)).toBe(12.345);
    expect(readablePixel(10)).toBe(10);
    expect(readablePixel(0.1)).toBe(0.1);
  });
});
