/** A bar of a round length for a picture of the sample. */

export interface ScaleBar {
  readonly um: number;
  /** CSS pixels. */
  readonly width: number;
  readonly text: string;
}

/** The longest of 1, 2, 5 times a power of ten that is no wider than `widest`. */
export function scaleBar(umPerPixel: number, widest: number): ScaleBar {
  const longest = umPerPixel * widest;
  const power = 10 ** Math.floor(Math.log10(longest) + 1e-9);
  const step = [5, 2, 1].find((factor) => factor * power <= longest * (1 + 1e-9)) ?? 1;
  const um = step * power;
  return { um, width: um / umPerPixel, text: lengthText(um) };
}

/** "200 µm", "5 mm". */
export function lengthText(um: number): string {
  return um >= 1000 ? `${round(um / 1000)} mm` : `${round(um)} µm`;
}

function round(value: number): string {
  return String(Number(value.toPrecision(6)));
}
