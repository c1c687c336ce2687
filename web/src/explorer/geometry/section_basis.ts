import type { Plane } from "./plane";
import { scale } from "./vector3";
import type { Vector3 } from "./vector3";

/** Directions of length 1 in a plane: columns of the picture advance along p, rows along q. */
export interface Basis {
  p: Vector3;
  q: Vector3;
}

export const basisKinds = ["layer", "xz"] as const;
export type BasisKind = (typeof basisKinds)[number];

/** As reconstruct/geometry/section_basis has it (after Khoperskov et al. 2017). */
export function sectionBasis(kind: BasisKind, { normal: [a, b, c] }: Plane): Basis {
  if (kind === "layer") {
    const across = Math.hypot(a, b);
    if (across === 0) return { p: [1, 0, 0], q: [0, 1, 0] };
    const p: Vector3 = [-b / across, a / across, 0];
    const reversed = p[0] < 0 || (p[0] === 0 && p[1] < 0);
    return { p: reversed ? scale(-1, p) : p, q: [(-a * c) / across, (-b * c) / across, across] };
  }
  const across = Math.hypot(a, c);
  if (across === 0) return { p: [1, 0, 0], q: [0, 0, 1] };
  const xi: Vector3 = [c / across, 0, -a / across];
  const reversed = xi[0] < 0 || (xi[0] === 0 && xi[2] < 0);
  return { p: reversed ? scale(-1, xi) : xi, q: [(-a * b) / across, across, (-b * c) / across] };
}
