/** The layers that the film strip shows, in order: all of them, or those of a filter. */

import type { LayerMark, LayerMarks } from "./layer_marks";

export type LayerFilter = "all" | "rejected" | "flagged";

export interface LayerSequence {
  readonly count: number;
  /** The layer at a place in the strip, from 0. */
  at(index: number): number;
  /** The place of a layer; of one that is not in the strip, that of the nearest; −1 when empty. */
  nearest(layer: number): number;
}

export function allLayers(count: number): LayerSequence {
  return {
    count,
    at: (index) => index + 1,
    nearest: (layer) => Math.min(Math.max(layer, 1), count) - 1,
  };
}

/** Layers in ascending order. */
export function someLayers(layers: readonly number[]): LayerSequence {
  return {
    count: layers.length,
    at: (index) => layers[index] ?? 0,
    nearest: (layer) => nearestIndex(layers, layer),
  };
}

function nearestIndex(layers: readonly number[], layer: number): number {
  let low = 0;
  let high = layers.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((layers[middle] ?? 0) < layer) low = middle + 1;
    else high = middle;
  }
  const after = layers[low];
  const before = layers[low - 1];
  if (after === undefined) return low - 1;
  return before !== undefined && layer - before < after - layer ? low - 1 : low;
}

const passes: Record<Exclude<LayerFilter, "all">, (mark: LayerMark) => boolean> = {
  rejected: (mark) => mark.rejected > 0,
  flagged: (mark) => mark.flagged,
};

/** The layers 1 to `highest` that pass the filter. */
export function filteredLayers(
  filter: LayerFilter,
  marks: LayerMarks,
  highest: number,
): LayerSequence {
  if (filter === "all") return allLayers(highest);
  const layers: number[] = [];
  for (const [layer, mark] of marks.byLayer) {
    if (layer <= highest && passes[filter](mark)) layers.push(layer);
  }
  return someLayers(layers.sort((a, b) => a - b));
}
