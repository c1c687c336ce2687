import type { Bound } from "../journal/metric_words";
import type { AttemptHistory } from "./attempt_history";

/** How many lines a limit is drawn as. */
export const limitLines = (bound: Bound): 0 | 1 | 2 =>
  bound === "none" ? 0 : bound === "within" ? 2 : 1;

/**
 * For a chart over layers, as uPlot takes it: layers, accepted values, rejected values, the limit,
 * and the limit on the other side where it counts either way. Attempts keep their order; a layer
 * that was tried twice stands there twice.
 */
export type ChartData = (number | null)[][];

export function chartData(history: AttemptHistory, name: string, bound: Bound): ChartData {
  const { value, limit } = history.column(name);
  const accepted = value.map((one, row) => (history.rejected[row] ? null : one));
  const rejected = value.map((one, row) => (history.rejected[row] ? one : null));
  const data: ChartData = [[...history.layer], accepted, rejected];
  const lines = limitLines(bound);
  if (lines > 0) data.push(limit);
  if (lines > 1) data.push(limit.map((one) => (one === null ? null : -one)));
  return data;
}

/** The first row whose layer is not below `layer`; `layers` is in growing order. */
export function firstRowFrom(layers: ArrayLike<number>, layer: number): number {
  let low = 0;
  let high = layers.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (layers[middle] < layer) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The last value that there is. */
export function lastOf(values: readonly (number | null)[]): number | null {
  for (let row = values.length - 1; row >= 0; row -= 1) {
    const value = values[row];
    if (value !== null && value !== undefined) return value;
  }
  return null;
}
