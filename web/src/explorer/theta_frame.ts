import { boundingRectangle, turnedBasis } from "./geometry/plane_rectangle";
import type { PlaneRectangle } from "./geometry/plane_rectangle";
import { signedDistance } from "./geometry/plane";
import { sectionBasis } from "./geometry/section_basis";
import type { Basis, BasisKind } from "./geometry/section_basis";
import { along, dot, subtract } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import type { PlacedPlane } from "./plane_state";
import type { Theta } from "./section_choices";

/** None for the inscribed ones: the server works those out. */
export function thetaFrame(
  theta: Theta,
  { plane, polygon }: PlacedPlane,
  kind: BasisKind,
): PlaneRectangle | null {
  const basis = sectionBasis(kind, plane);
  if (theta.kind === "bounding") {
    return polygon.length < 3 ? null : boundingRectangle(polygon, basis);
  }
  if (theta.kind !== "custom") return null;
  const { corner, width, height, angle } = theta;
  const origin = along(corner, -signedDistance(plane, corner), plane.normal);
  return { origin, ...turnedBasis(basis, angle), width, height };
}

/** What is known without the server moves with the hand. */
export const isKnownHere = (theta: Theta): boolean =>
  theta.kind === "bounding" || theta.kind === "custom";

const toNanometres = (um: number): number => Number(um.toFixed(3)) + 0;

/** The rectangle along `axes` with two opposite corners; none where it would have no area. */
export function customBetween(
  { p, q }: Basis,
  angle: number,
  from: Vector3,
  to: Vector3,
): (Theta & { kind: "custom" }) | null {
  const across = dot(subtract(to, from), p);
  const down = dot(subtract(to, from), q);
  const corner = along(along(from, Math.min(0, across), p), Math.min(0, down), q);
  const [width, height] = [toNanometres(Math.abs(across)), toNanometres(Math.abs(down))];
  if (width === 0 || height === 0) return null;
  return {
    kind: "custom",
    corner: corner.map(toNanometres) as unknown as Vector3,
    width,
    height,
    angle,
  };
}
