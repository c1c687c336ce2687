import { withUnit } from "./numbers";

/** Lengths in the sample, as people read them. */

/** The longest of 1, 2 or 5 times a power of ten that is no more than `longest`: for a scale bar. */
export function roundLength(longest: number): number {
  const spare = 1 + 1e-9; // of a rounding error
  const power = 10 ** Math.floor(Math.log10(longest * spare));
  return (([5, 2, 1] as const).find((times) => times * power <= longest * spare) ?? 1) * power;
}

/** "200 µm", "2.5 mm". */
export function lengthWords(um: number): string {
  const trimmed = (value: number) => String(Number(value.toPrecision(4)));
  return um >= 1000 ? withUnit(trimmed(um / 1000), "mm") : withUnit(trimmed(um), "µm");
}
