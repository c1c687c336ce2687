import type { Sample } from "../../src/api/types";

/** A sample of 80 layers, with as much of what is known of one as the explorer looks at. */
export const aSample = {
  size: [1000, 1000, 80],
  spacing_um: [10, 10, 20],
  layers_present: 80,
  generation: 1,
} as unknown as Sample;
