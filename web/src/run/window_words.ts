import type { Window } from "../api/types";
import { type MaybeNumber, decimalsOf, fixed, withUnit } from "../ui/numbers";

export type Fit = "good" | "low" | "high" | "unknown";

/** Whether a value is where it may be. */
export function fit(value: MaybeNumber, window: Window | null | undefined): Fit {
  if (typeof value !== "number" || !Number.isFinite(value)) return "unknown";
  const [low, high] = window ?? [null, null];
  if (low !== null && value < low) return "low";
  if (high !== null && value > high) return "high";
  return "good";
}

/** "−25 to −15 °C", "at most 80 %", "at least 3 °C"; null where there is no limit. */
export function windowWords(
  window: Window | null | undefined,
  unit: string,
  decimals = 0,
): string | null {
  const [low, high] = window ?? [null, null];
  // No more decimals than it has.
  const text = (value: number) => fixed(value, Math.min(decimals, decimalsOf(value)));
  if (low !== null && high !== null) return withUnit(`${text(low)} to ${text(high)}`, unit);
  if (high !== null) return withUnit(`at most ${text(high)}`, unit);
  if (low !== null) return withUnit(`at least ${text(low)}`, unit);
  return null;
}
