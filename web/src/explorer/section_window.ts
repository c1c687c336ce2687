import { angleFrom, inPlane, inSample } from "./geometry/plane_rectangle";
import type { InPlane, PlaneRectangle } from "./geometry/plane_rectangle";
import type { Basis } from "./geometry/section_basis";
import type { Vector3 } from "./geometry/vector3";
import type { Theta } from "./section_choices";
import type { Closeup } from "./view_hash";

/**
 * The window through which a section is looked at. `frame` is the rectangle of the section that can
 * be seen in it; places in it are micrometres from the frame's first corner, along p and q.
 */
export interface SectionWindow {
  frame: PlaneRectangle;
  width: number; // pixels of the screen, not of CSS
  height: number;
  middle: InPlane; // shown in the middle of the window
  pixel: number; // micrometres in a pixel of the screen
}

/** The pixel of the screen with which the whole frame is just seen. */
export function fittingPixel(frame: PlaneRectangle, width: number, height: number): number {
  const across = frame.width / Math.max(1, width - 1);
  const down = frame.height / Math.max(1, height - 1);
  return Math.max(across, down) || 1;
}

/** Where voxels are larger than the screen's pixels, every two are equally many pixels large. */
export const evenPixel = (fitting: number, voxel: number): number =>
  fitting < voxel ? (2 * voxel) / Math.floor((2 * voxel) / fitting) : fitting;

export function wholeWindow(
  frame: PlaneRectangle,
  width: number,
  height: number,
  pixel = fittingPixel(frame, width, height),
): SectionWindow {
  return { frame, width, height, middle: [frame.width / 2, frame.height / 2], pixel };
}

export function closeupWindow(
  frame: PlaneRectangle,
  width: number,
  height: number,
  { middle, pixel }: Closeup,
): SectionWindow {
  return { frame, width, height, middle: inPlane(frame, middle), pixel };
}

/** What is seen at a pixel of the window, counted from its upper left corner. */
export const placeAt = (window: SectionWindow, x: number, y: number): InPlane => [
  window.middle[0] + (x - window.width / 2) * window.pixel,
  window.middle[1] + (y - window.height / 2) * window.pixel,
];

export const pixelAt = (window: SectionWindow, [a, b]: InPlane): [number, number] => [
  (a - window.middle[0]) / window.pixel + window.width / 2,
  (b - window.middle[1]) / window.pixel + window.height / 2,
];

export const sampleAtPixel = (window: SectionWindow, x: number, y: number): Vector3 =>
  inSample(window.frame, placeAt(window, x, y));

/** A voxel is shown at most so many pixels of the screen wide. */
const mostEnlarged = 24;

/**
 * Nearer by `factor`; what is seen at pixel (x, y) stays there. None where all of it just fits. A
 * section with fewer voxels than the window has pixels may be shown smaller, down to a voxel a pixel,
 * in the middle. `voxel`: the least spacing.
 */
export function zoomedAt(
  window: SectionWindow,
  factor: number,
  [x, y]: readonly [number, number],
  voxel: number,
): Closeup | null {
  const { frame, width, height } = window;
  const fitting = evenPixel(fittingPixel(frame, width, height), voxel);
  const finest = Math.max(voxel / mostEnlarged, window.pixel / factor);
  const pixel = readablePixel(Math.min(finest, Math.max(voxel, fitting)));
  if (Math.abs(pixel / fitting - 1) < 0.001) return null;
  const [a, b] = placeAt(window, x, y);
  const middle: InPlane =
    pixel > fitting
      ? [frame.width / 2, frame.height / 2]
      : [a - (x - width / 2) * pixel, b - (y - height / 2) * pixel];
  return { middle: inSample(frame, withinFrame(frame, middle)), pixel };
}

/** Moved by so many pixels of the screen; its middle stays on the frame. */
export function movedBy(window: SectionWindow, right: number, down: number): Closeup {
  const middle: InPlane = [
    window.middle[0] + right * window.pixel,
    window.middle[1] + down * window.pixel,
  ];
  return {
    middle: inSample(window.frame, withinFrame(window.frame, middle)),
    pixel: window.pixel,
  };
}

const withinFrame = ({ width, height }: PlaneRectangle, [a, b]: InPlane): InPlane => [
  Math.min(width, Math.max(0, a)),
  Math.min(height, Math.max(0, b)),
];

const wholePixel = 1e-6; // as in reconstruct/section/pixel_grid

/**
 * The part of the frame that is seen, cut into pixels of a size. Its pixels are pixels of the whole
 * frame at that size, so that nothing shimmers when the window moves. None when nothing is seen.
 */
export function visiblePart(
  window: SectionWindow,
  pixel: number,
  basis: Basis,
): (Theta & { kind: "custom" }) | null {
  const span = (middle: number, pixels: number, length: number): [number, number] | null => {
    const half = (pixels / 2) * window.pixel;
    const last = Math.floor(length / pixel + wholePixel);
    const from = Math.max(0, Math.floor((middle - half) / pixel));
    const to = Math.min(last, Math.ceil((middle + half) / pixel));
    return from <= to ? [from, to] : null;
  };
  const across = span(window.middle[0], window.width, window.frame.width);
  const down = span(window.middle[1], window.height, window.frame.height);
  if (!across || !down) return null;
  // A single row or column has no extent; the server wants one, and half a pixel adds no other.
  const length = ([from, to]: [number, number]) => Math.max(to - from, 0.5) * pixel;
  return {
    kind: "custom",
    corner: inSample(window.frame, [across[0] * pixel, down[0] * pixel]),
    width: length(across),
    height: length(down),
    angle: angleFrom(basis, window.frame),
  };
}

/** A size of a pixel that people can read, no larger than asked. */
export function readablePixel(pixel: number): number {
  const unit = 10 ** (Math.floor(Math.log10(pixel)) - 4);
  return Number((Math.floor(pixel / unit + wholePixel) * unit).toPrecision(5));
}

/** Where a picture of the frame's plane lies in the window: pixels of the screen. */
export interface Placement {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** A picture whose pixels are the screen's falls on whole ones. */
export function placementOf(
  window: SectionWindow,
  first: Vector3, // centre of the picture's pixel (0, 0)
  picturePixel: number,
  columns: number,
  rows: number,
): Placement {
  const [a, b] = inPlane(window.frame, first);
  const half = picturePixel / 2;
  const [left, top] = pixelAt(window, [a - half, b - half]);
  const ratio = picturePixel / window.pixel;
  const same = Math.abs(ratio - 1) * Math.max(columns, rows) < 0.5;
  return {
    left: Math.round(left),
    top: Math.round(top),
    width: same ? columns : columns * ratio,
    height: same ? rows : rows * ratio,
  };
}
