import { lengthWords, roundLength } from "../ui/lengths";

/** A bar of a round length for a picture of the sample. */

export interface ScaleBar {
  readonly um: number;
  /** CSS pixels. */
  readonly width: number;
  readonly text: string;
}

/** As long as it can be, but no wider than `widest`. */
export function scaleBar(umPerPixel: number, widest: number): ScaleBar {
  const um = roundLength(umPerPixel * widest);
  return { um, width: um / umPerPixel, text: lengthWords(um) };
}
