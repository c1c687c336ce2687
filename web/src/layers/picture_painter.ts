import type { Sharpness } from "../api/types";
import { cssColour, scaleColour } from "./colour_scale";
import type { Piece } from "./picture_source";
import { mapTile, partOf, type ValueRange } from "./sharpness_map";
import type { Rectangle } from "./tile_pyramid";
import type { Shape, Viewport } from "./viewport";

/** A canvas in pixels of the device, and how its view lies in it. */
export interface Canvas {
  readonly context: CanvasRenderingContext2D;
  readonly width: number;
  readonly height: number;
  /** Pixels of the device per CSS pixel. */
  readonly ratio: number;
}

/**
 * From places in the picture to whole pixels of the device. All edges are rounded alike, so that
 * tiles meet without a seam, and at 1:1 each pixel of the picture is one of the device.
 */
class Placement {
  private readonly left: number;
  private readonly top: number;
  private readonly scaleX: number;
  private readonly scaleY: number;

  constructor(canvas: Canvas, view: Viewport, shape: Shape) {
    this.scaleX = view.scale * canvas.ratio;
    this.scaleY = this.scaleX * shape.stretch;
    this.left = Math.round(canvas.width / 2 - view.x * this.scaleX);
    this.top = Math.round(canvas.height / 2 - view.y * this.scaleY);
  }

  /** Left, top, width, height. */
  place(covers: Rectangle): [number, number, number, number] {
    const left = this.left + Math.round(covers.left * this.scaleX);
    const top = this.top + Math.round(covers.top * this.scaleY);
    const right = this.left + Math.round(covers.right * this.scaleX);
    const bottom = this.top + Math.round(covers.bottom * this.scaleY);
    return [left, top, right - left, bottom - top];
  }

  /** Pixels of the device for one of the picture. */
  get enlarged(): number {
    return this.scaleX;
  }
}

export interface Overlay {
  readonly map: Sharpness;
  /** Of the colours. */
  readonly range: ValueRange;
  /** From 0 to 1. */
  readonly opacity: number;
}

/** Paints the pieces, and the map over them. */
export function paintPicture(
  canvas: Canvas,
  view: Viewport,
  shape: Shape,
  pieces: readonly Piece[],
  overlay: Overlay | null,
): void {
  const { context } = canvas;
  const placement = new Placement(canvas, view, shape);
  const whole = { left: 0, top: 0, right: shape.width, bottom: shape.height };
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.save();
  context.beginPath();
  context.rect(...placement.place(whole));
  context.clip();
  context.imageSmoothingQuality = "high";
  for (const piece of pieces) {
    // Enlarged, a pixel of the camera is shown as what it is; a coarse tile is a stand-in.
    context.imageSmoothingEnabled = piece.reduced !== 1 || placement.enlarged < 2;
    context.drawImage(piece.bitmap, ...placement.place(piece.covers));
  }
  if (overlay) paintMap(context, placement, overlay);
  context.restore();
}

function paintMap(
  context: CanvasRenderingContext2D,
  placement: Placement,
  { map, range, opacity }: Overlay,
): void {
  context.globalAlpha = opacity;
  map.values.forEach((value, number) => {
    if (value === null) return;
    context.fillStyle = cssColour(scaleColour(partOf(value, range)));
    context.fillRect(...placement.place(mapTile(map, number)));
  });
  context.globalAlpha = 1;
}

const minimapWidest = 140;
const minimapMargin = 10;

/** The whole picture, small, in the upper right corner, and in it a frame around what is seen. */
export function paintMinimap(canvas: Canvas, shape: Shape, seen: Rectangle, whole: Piece): void {
  const { context, ratio } = canvas;
  const longest = Math.max(shape.width, shape.height * shape.stretch);
  const scale = (minimapWidest * ratio) / longest;
  const width = Math.round(shape.width * scale);
  const height = Math.round(shape.height * shape.stretch * scale);
  const left = canvas.width - width - Math.round(minimapMargin * ratio);
  const top = Math.round(minimapMargin * ratio);
  context.imageSmoothingEnabled = true;
  context.fillStyle = "#fff";
  context.fillRect(left - ratio, top - ratio, width + 2 * ratio, height + 2 * ratio);
  context.drawImage(whole.bitmap, left, top, width, height);
  const within = (place: number, end: number) => Math.min(Math.max(place, 0), end);
  const x = within(seen.left, shape.width) * scale;
  const y = within(seen.top, shape.height) * scale * shape.stretch;
  const right = within(seen.right, shape.width) * scale;
  const bottom = within(seen.bottom, shape.height) * scale * shape.stretch;
  for (const [colour, line] of [
    ["#000", 4],
    ["#ffe93e", 2],
  ] as const) {
    context.strokeStyle = colour;
    context.lineWidth = line * ratio;
    context.strokeRect(left + x, top + y, right - x, bottom - y);
  }
}
