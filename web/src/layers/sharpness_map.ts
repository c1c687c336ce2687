/** The tile map of sharpness of a layer, as /api/v1/layers/N/sharpness gives it. */

import type { Sharpness } from "../api/types";
import type { Rectangle } from "./tile_pyramid";
import type { Point } from "./viewport";

export interface ValueRange {
  readonly low: number;
  readonly high: number;
}

/**
 * The values that the ends of the colour scale stand for: a twentieth of the tiles at either end
 * may lie beyond, so that one odd tile does not take the colours from all others. Nothing where no
 * tile has a value.
 */
export function shownRange(map: Sharpness): ValueRange | null {
  const values = map.values.filter((value): value is number => value !== null);
  if (values.length === 0) return null;
  values.sort((a, b) => a - b);
  const at = (part: number) => values[Math.round(part * (values.length - 1))] ?? 0;
  const low = at(0.05);
  const high = at(0.95);
  return high > low ? { low, high } : { low: at(0), high: at(1) };
}

/** Half as sharp, as sharp, half as sharp again: the middle of the scale is "as before". */
export const changeRange: ValueRange = { low: 0.5, high: 1.5 };

/**
 * Each tile's value over that of the layer before: tissue differs in detail from place to place, but
 * little from layer to layer. Null where one of them has none, or where the tiles are others.
 */
export function changeMap(map: Sharpness, before: Sharpness): Sharpness {
  const alike = map.columns === before.columns && map.rows === before.rows;
  const values = map.values.map((value, tile) => {
    const old = alike ? before.values[tile] : null;
    return value === null || old === null || old <= 0 ? null : value / old;
  });
  return { ...map, values };
}

/** Where a value stands between the ends of the scale, from 0 to 1. */
export function partOf(value: number, range: ValueRange): number {
  if (range.high <= range.low) return 0.5;
  return Math.min(Math.max((value - range.low) / (range.high - range.low), 0), 1);
}

/** The tile's number at a place in pixels of the image; nothing beside the picture. */
export function tileAt(map: Sharpness, place: Point): number | null {
  const column = Math.floor(place.x / map.tile_width);
  const row = Math.floor(place.y / map.tile_height);
  if (column < 0 || row < 0) return null;
  if (column >= map.columns || row >= map.rows) return null;
  return row * map.columns + column;
}

/** What a tile covers, in pixels of the image. */
export function mapTile(map: Sharpness, number: number): Rectangle {
  const column = number % map.columns;
  const row = Math.floor(number / map.columns);
  return {
    left: column * map.tile_width,
    top: row * map.tile_height,
    right: (column + 1) * map.tile_width,
    bottom: (row + 1) * map.tile_height,
  };
}
