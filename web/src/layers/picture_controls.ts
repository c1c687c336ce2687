import type { Signal } from "@preact/signals";

import type { PictureScreen } from "./picture_screen";
import { PointerGestures, type PointerPlace } from "./pointer_gestures";
import { moved, tapped, zoomed, type Point } from "./viewport";

export interface ControlledPicture {
  readonly canvas: HTMLCanvasElement;
  readonly screen: PictureScreen;
  /** The place in the picture under the cursor. */
  readonly cursor: Signal<Point | null>;
  /** To the next picture (1) or the one before (−1), while all of this one is in sight. */
  turned(direction: -1 | 1): void;
}

/** Zooming by one press of a key or a button. */
export const zoomStep = Math.SQRT2;
const wheelStep = 0.0015;
const pinchStep = 0.01; // of a trackpad, which tells its pinch as a wheel with Ctrl
const lineHeight = 16;

/** Makes mouse, wheel and fingers move the picture; gives what ends it. */
export function controlPicture(of: ControlledPicture): () => void {
  const { canvas, screen } = of;
  const ended = new AbortController();
  const { signal } = ended;

  let touched = false;
  const gestures = new PointerGestures({
    dragged: (by) => screen.change((view, ...frame) => moved(view, by, ...frame)),
    pinched: (factor, at, by) =>
      screen.change((view, ...frame) => zoomed(moved(view, by, ...frame), factor, at, ...frame)),
    doubleTapped: (at) => screen.change((view, ...frame) => tapped(view, at, ...frame)),
    swiped: (direction) => {
      if (touched && screen.allInSight()) of.turned(direction === -1 ? 1 : -1);
    },
  });

  const place = (event: PointerEvent | WheelEvent): Point => {
    const { left, top } = canvas.getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  };
  const pointer = (event: PointerEvent): PointerPlace => ({
    ...place(event),
    id: event.pointerId,
    timeMs: event.timeStamp,
  });
  canvas.addEventListener(
    "pointerdown",
    (event) => {
      if (event.button !== 0) return;
      touched = event.pointerType === "touch";
      canvas.setPointerCapture(event.pointerId);
      gestures.down(pointer(event));
    },
    { signal },
  );
  canvas.addEventListener(
    "pointermove",
    (event) => {
      gestures.move(pointer(event));
      of.cursor.value = screen.placeAt(place(event));
    },
    { signal },
  );
  canvas.addEventListener("pointerup", (event) => gestures.up(pointer(event)), { signal });
  canvas.addEventListener("pointercancel", (event) => gestures.cancel(event.pointerId), { signal });
  canvas.addEventListener("pointerleave", () => (of.cursor.value = null), { signal });
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? lineHeight : 1;
      const step = event.ctrlKey ? pinchStep : wheelStep;
      const factor = Math.exp(-event.deltaY * lines * step);
      screen.change((view, ...frame) => zoomed(view, factor, place(event), ...frame));
    },
    { signal, passive: false },
  );
  return () => ended.abort();
}

/** Larger or smaller about the middle. */
export function zoomBy(screen: PictureScreen, factor: number): void {
  screen.change((view, shape, frame, ratio) => {
    const middle = { x: frame.width / 2, y: frame.height / 2 };
    return zoomed(view, factor, middle, shape, frame, ratio);
  });
}

/** A pixel of the picture on each pixel of the screen. */
export function zoomToPixels(screen: PictureScreen): void {
  screen.change((view, shape, frame, ratio) => {
    const middle = { x: frame.width / 2, y: frame.height / 2 };
    return zoomed(view, 1 / ratio / view.scale, middle, shape, frame, ratio);
  });
}

/** The picture moved by a part of the frame. */
export function shiftBy(screen: PictureScreen, parts: Point): void {
  screen.change((view, shape, frame, ratio) => {
    const by = { x: -parts.x * frame.width, y: -parts.y * frame.height };
    return moved(view, by, shape, frame, ratio);
  });
}
