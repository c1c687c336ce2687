import { describe, expect, it } from "vitest";

import {
  fitted,
  held,
  isAllInSight,
  isFitted,
  moved,
  seen,
  tapped,
  toPicture,
  toScreen,
  zoomed,
} from "../../src/layers/viewport";

const shape = { width: 10000, height: 5000, stretch: 1 };
const frame = { width: 1000, height: 800 };

describe("a fitted view", () => {
  it("shows the whole picture in the middle", () => {
    const view = fitted(shape, frame);
    expect(view).toEqual({ x: 5000, y: 2500, scale: 0.1 });
    expect(isFitted(view, shape, frame)).toBe(true);
    expect(isAllInSight(view, shape, frame)).toBe(true);
  });

  it("is not taken for a smaller one, nor for a larger one", () => {
    const smaller = { ...fitted(shape, frame), scale: 0.09 };
    expect(isFitted(smaller, shape, frame)).toBe(false);
    expect(isAllInSight(smaller, shape, frame)).toBe(true);
    const larger = { ...smaller, scale: 0.11 };
    expect(isFitted(larger, shape, frame)).toBe(false);
    expect(isAllInSight(larger, shape, frame)).toBe(false);
  });

  it("is bounded by the height where that is the tighter side", () => {
    expect(fitted(shape, { width: 1000, height: 250 }).scale).toBe(0.05);
  });

  it("counts the height of pixels that are not square", () => {
    expect(fitted({ ...shape, stretch: 4 }, frame).scale).toBe(0.04);
  });

  it("is of some size while the frame has none", () => {
    expect(fitted(shape, { width: 0, height: 0 }).scale).toBe(1);
  });
});

describe("places", () => {
  it("go to the screen and back", () => {
    const tall = { ...shape, stretch: 1.5 };
    const view = { x: 1234.5, y: 987.25, scale: 2.5 };
    const place = toPicture({ x: 17, y: 600 }, view, tall, frame);
    const back = toScreen(place, view, tall, frame);
    expect(back.x).toBeCloseTo(17, 9);
    expect(back.y).toBeCloseTo(600, 9);
  });

  it("are seen as far as the frame reaches", () => {
    expect(seen({ x: 5000, y: 2500, scale: 1 }, shape, frame)).toEqual({
      left: 4500,
      top: 2100,
      right: 5500,
      bottom: 2900,
    });
  });
});

describe("zooming", () => {
  it("leaves the place under the cursor where it is", () => {
    const view = { x: 5000, y: 2500, scale: 0.5 };
    const at = { x: 200, y: 300 };
    const before = toPicture(at, view, shape, frame);
    const after = toPicture(at, zoomed(view, 1.7, at, shape, frame, 1), shape, frame);
    expect(after.x).toBeCloseTo(before.x, 6);
    expect(after.y).toBeCloseTo(before.y, 6);
  });

  it("ends at the whole picture and at sixteen screen pixels for one", () => {
    const view = { x: 5000, y: 2500, scale: 0.5 };
    const at = { x: 500, y: 400 };
    expect(zoomed(view, 1e-6, at, shape, frame, 1)).toEqual(fitted(shape, frame));
    expect(zoomed(view, 1e6, at, shape, frame, 1).scale).toBe(16);
    expect(zoomed(view, 1e6, at, shape, frame, 2).scale).toBe(8);
  });

  it("lets a small picture shrink from the frame to its own pixels", () => {
    const small = { width: 100, height: 80, stretch: 1 };
    const least = held({ x: 50, y: 40, scale: 0.01 }, small, frame, 2);
    expect(least.scale).toBe(0.5);
  });
});

describe("moving", () => {
  it("follows the hand", () => {
    const view = { x: 5000, y: 2500, scale: 2 };
    expect(moved(view, { x: 10, y: -20 }, shape, frame, 1)).toEqual({ x: 4995, y: 2510, scale: 2 });
  });

  it("stops where the picture ends", () => {
    const view = { x: 5000, y: 2500, scale: 1 };
    expect(moved(view, { x: 1e6, y: 1e6 }, shape, frame, 1)).toEqual({ x: 500, y: 400, scale: 1 });
    const far = { x: -1e6, y: -1e6 };
    expect(moved(view, far, shape, frame, 1)).toEqual({ x: 9500, y: 4600, scale: 1 });
  });

  it("leaves a side in the middle that is wholly in sight", () => {
    const view = moved(fitted(shape, frame), { x: 30, y: 30 }, shape, frame, 1);
    expect(view).toEqual(fitted(shape, frame));
  });
});

describe("a double tap", () => {
  const at = { x: 250, y: 400 };

  it("shows the pixels of a large picture, and all of it again", () => {
    const close = tapped(fitted(shape, frame), at, shape, frame, 2);
    expect(close.scale).toBe(0.5);
    expect(toPicture(at, close, shape, frame).x).toBeCloseTo(2500, 6);
    expect(tapped(close, at, shape, frame, 2)).toEqual(fitted(shape, frame));
  });

  it("enlarges a picture of few pixels", () => {
    const small = { width: 500, height: 400, stretch: 1 };
    expect(tapped(fitted(small, frame), at, small, frame, 1).scale).toBe(6);
  });
});
