/**
 * Between pixels of a layer's image and micrometres of the sample: the *centre* of the upper left
 * pixel is the sample's origin (docs/geometry.md), while places in a picture are counted from its
 * corner.
 */

import { micrometres } from "../ui/numbers";
import type { Point, Viewport } from "./viewport";

export interface PixelSize {
  /** Micrometres, along x and y. */
  readonly x: number;
  readonly y: number;
}

export function toSample(place: Point, pixel: PixelSize): Point {
  return { x: (place.x - 0.5) * pixel.x, y: (place.y - 0.5) * pixel.y };
}

export function fromSample(um: Point, pixel: PixelSize): Point {
  return { x: um.x / pixel.x + 0.5, y: um.y / pixel.y + 0.5 };
}

/** Decimals with which a place is told: no more than a tenth of a pixel means anything. */
export function placeDecimals(pixel: PixelSize): number {
  return Math.min(Math.max(Math.ceil(-Math.log10(Math.min(pixel.x, pixel.y))) + 1, 0), 4);
}

/** How far a layer's face lies below the first one. */
export function depthText(layer: number, thicknessUm: number): string {
  return micrometres((layer - 1) * thicknessUm, Number.isInteger(thicknessUm) ? 0 : 2);
}

/** The view as parameters of a link: its middle in micrometres, and its scale. */
export function viewToLink(view: Viewport, pixel: PixelSize): URLSearchParams {
  const middle = toSample(view, pixel);
  const decimals = placeDecimals(pixel);
  return new URLSearchParams({
    at: `${middle.x.toFixed(decimals)},${middle.y.toFixed(decimals)}`,
    zoom: String(Number(view.scale.toPrecision(5))),
  });
}

/** The view that a link names; nothing when it names none, or none that can be. */
export function viewFromLink(parameters: URLSearchParams, pixel: PixelSize): Viewport | null {
  const at = parameters.get("at")?.split(",") ?? [];
  const [x, y] = at.map((text) => (text.trim() === "" ? NaN : Number(text)));
  const scale = Number(parameters.get("zoom") ?? NaN);
  if (at.length !== 2 || x === undefined || y === undefined) return null;
  if (!Number.isFinite(x) || !Number.isFinite(y) || !Number.isFinite(scale) || scale <= 0)
    return null;
  return { ...fromSample({ x, y }, pixel), scale };
}
