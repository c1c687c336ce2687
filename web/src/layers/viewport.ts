/**
 * What of a picture is seen in a frame on the screen, and how large. Places in the picture are in
 * its pixels from its upper left corner (pixel i reaches from i to i + 1), places on the screen in
 * CSS pixels from the frame's.
 */

import type { PictureSize, Rectangle } from "./tile_pyramid";

export interface Point {
  readonly x: number;
  readonly y: number;
}

export interface Frame {
  readonly width: number;
  readonly height: number;
}

/** A picture whose pixels need not be square. */
export interface Shape extends PictureSize {
  /** Height of a pixel over its width. */
  readonly stretch: number;
}

export interface Viewport {
  /** The picture's place in the middle of the frame. */
  readonly x: number;
  readonly y: number;
  /** Screen pixels per pixel of the picture, along x. */
  readonly scale: number;
}

/** How many pixels of the device a pixel of the picture may become. */
const largestPixel = 16;

/** The whole picture, as large as the frame takes it. */
export function fitted(shape: Shape, frame: Frame): Viewport {
  return { x: shape.width / 2, y: shape.height / 2, scale: fittedScale(shape, frame) };
}

function fittedScale(shape: Shape, frame: Frame): number {
  const scale = Math.min(frame.width / shape.width, frame.height / (shape.height * shape.stretch));
  return scale > 0 ? scale : 1;
}

const rounding = 0.001; // of a scale

/** As large as the frame takes the whole picture. */
export function isFitted(view: Viewport, shape: Shape, frame: Frame): boolean {
  return Math.abs(view.scale / fittedScale(shape, frame) - 1) <= rounding;
}

/** Likewise, or smaller. */
export function isAllInSight(view: Viewport, shape: Shape, frame: Frame): boolean {
  return view.scale <= fittedScale(shape, frame) * (1 + rounding);
}

/**
 * The view held to what makes sense: no smaller than the whole picture (or than its own pixels,
 * where the frame is larger), no larger than `largestPixel`, and no frame half empty.
 */
export function held(view: Viewport, shape: Shape, frame: Frame, pixelRatio: number): Viewport {
  const whole = fittedScale(shape, frame);
  const least = Math.min(whole, 1 / pixelRatio);
  const most = Math.max(whole, largestPixel / pixelRatio);
  const scale = Math.min(Math.max(view.scale, least), most);
  return {
    x: heldAlong(view.x, shape.width, frame.width / scale),
    y: heldAlong(view.y, shape.height, frame.height / (scale * shape.stretch)),
    scale,
  };
}

function heldAlong(middle: number, length: number, seen: number): number {
  if (seen >= length) return length / 2;
  return Math.min(Math.max(middle, seen / 2), length - seen / 2);
}

export function toPicture(at: Point, view: Viewport, shape: Shape, frame: Frame): Point {
  return {
    x: view.x + (at.x - frame.width / 2) / view.scale,
    y: view.y + (at.y - frame.height / 2) / (view.scale * shape.stretch),
  };
}

export function toScreen(place: Point, view: Viewport, shape: Shape, frame: Frame): Point {
  return {
    x: frame.width / 2 + (place.x - view.x) * view.scale,
    y: frame.height / 2 + (place.y - view.y) * view.scale * shape.stretch,
  };
}

/** What of the picture's plane the frame shows; it may reach beyond the picture. */
export function seen(view: Viewport, shape: Shape, frame: Frame): Rectangle {
  const { x: left, y: top } = toPicture({ x: 0, y: 0 }, view, shape, frame);
  const { x: right, y: bottom } = toPicture(
    { x: frame.width, y: frame.height },
    view,
    shape,
    frame,
  );
  return { left, top, right, bottom };
}

/** Larger by `factor`; the place under `at` stays under it. */
export function zoomed(
  view: Viewport,
  factor: number,
  at: Point,
  shape: Shape,
  frame: Frame,
  pixelRatio: number,
): Viewport {
  const scale = held({ ...view, scale: view.scale * factor }, shape, frame, pixelRatio).scale;
  const place = toPicture(at, view, shape, frame);
  const moved = {
    x: place.x - (at.x - frame.width / 2) / scale,
    y: place.y - (at.y - frame.height / 2) / (scale * shape.stretch),
    scale,
  };
  return held(moved, shape, frame, pixelRatio);
}

/** The picture moved along with a hand that moved by `by` on the screen. */
export function moved(
  view: Viewport,
  by: Point,
  shape: Shape,
  frame: Frame,
  pixelRatio: number,
): Viewport {
  const next = {
    x: view.x - by.x / view.scale,
    y: view.y - by.y / (view.scale * shape.stretch),
    scale: view.scale,
  };
  return held(next, shape, frame, pixelRatio);
}

/** Twice tapped: from a small picture to its own pixels, or three times as large; else back to all. */
export function tapped(
  view: Viewport,
  at: Point,
  shape: Shape,
  frame: Frame,
  pixelRatio: number,
): Viewport {
  if (!isAllInSight(view, shape, frame)) return fitted(shape, frame);
  const factor = Math.max(1 / pixelRatio / view.scale, 3);
  return zoomed(view, factor, at, shape, frame, pixelRatio);
}
