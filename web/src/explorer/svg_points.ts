import type { Vector3 } from "./geometry/vector3";

/** The attribute `points` of a polygon, to a tenth of a CSS pixel. */
export const svgPoints = (
  points: readonly Vector3[],
  toScreen: (point: Vector3) => readonly [number, number],
): string =>
  points
    .map((point) =>
      toScreen(point)
        .map((value) => value.toFixed(1))
        .join(","),
    )
    .join(" ");
