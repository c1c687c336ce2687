import { describe, expect, it, vi } from "vitest";

import { PointerGestures } from "../../src/layers/pointer_gestures";

function bench() {
  const heard = { dragged: vi.fn(), pinched: vi.fn(), doubleTapped: vi.fn(), swiped: vi.fn() };
  return { heard, gestures: new PointerGestures(heard) };
}

const at = (x: number, y: number, timeMs = 0, id = 1) => ({ id, x, y, timeMs });

describe("one finger", () => {
  it("drags", () => {
    const { heard, gestures } = bench();
    gestures.down(at(10, 10));
    gestures.move(at(15, 8));
    gestures.move(at(16, 9));
    expect(heard.dragged.mock.calls).toEqual([[{ x: 5, y: -2 }], [{ x: 1, y: 1 }]]);
  });

  it("moves nothing while it is up", () => {
    const { heard, gestures } = bench();
    gestures.move(at(15, 8));
    expect(heard.dragged).not.toHaveBeenCalled();
  });

  it("swipes when it goes sideways quickly", () => {
    const { heard, gestures } = bench();
    gestures.down(at(200, 100, 0));
    gestures.up(at(100, 110, 200));
    gestures.down(at(100, 100, 1000));
    gestures.up(at(200, 110, 1200));
    expect(heard.swiped.mock.calls).toEqual([[-1], [1]]);
  });

  it.each([
    [100, 110, 900, "slowly"],
    [100, 200, 200, "downwards"],
    [170, 100, 200, "a little"],
  ])("does not swipe to %f, %f in %f ms: %s", (x, y, timeMs) => {
    const { heard, gestures } = bench();
    gestures.down(at(200, 100, 0));
    gestures.up(at(x, y, timeMs));
    expect(heard.swiped).not.toHaveBeenCalled();
  });

  it("taps twice", () => {
    const { heard, gestures } = bench();
    const tap = (x: number, timeMs: number) => {
      gestures.down(at(x, 50, timeMs));
      gestures.up(at(x, 50, timeMs + 50));
    };
    tap(50, 0);
    tap(52, 200);
    expect(heard.doubleTapped).toHaveBeenCalledOnce();
    tap(52, 300);
    expect(heard.doubleTapped).toHaveBeenCalledOnce();
    tap(52, 2000);
    tap(152, 2200);
    expect(heard.doubleTapped).toHaveBeenCalledOnce();
  });
});

describe("two fingers", () => {
  it("pinch about their middle and neither swipe nor tap", () => {
    const { heard, gestures } = bench();
    gestures.down(at(100, 100, 0, 1));
    gestures.down(at(200, 100, 0, 2));
    gestures.move(at(300, 100, 10, 2));
    expect(heard.pinched).toHaveBeenCalledWith(2, { x: 200, y: 100 }, { x: 50, y: 0 });
    gestures.up(at(300, 100, 20, 2));
    gestures.up(at(100, 100, 30, 1));
    expect(heard.swiped).not.toHaveBeenCalled();
    expect(heard.doubleTapped).not.toHaveBeenCalled();
  });

  it("leave the other one dragging", () => {
    const { heard, gestures } = bench();
    gestures.down(at(100, 100, 0, 1));
    gestures.down(at(200, 100, 0, 2));
    gestures.cancel(2);
    gestures.move(at(105, 100, 10, 1));
    expect(heard.dragged).toHaveBeenCalledWith({ x: 5, y: 0 });
  });
});
