import type { Basis } from "./section_basis";
import { add, along, direction, dot, scale, subtract } from "./vector3";
import type { Vector3 } from "./vector3";

/** A place in a section: micrometres along p and q. */
export type InPlane = readonly [number, number];

/**
 * A rectangle of a section plane. `origin` is its first corner, with the least coordinates along
 * both axes; width goes along p and height along q, in micrometres.
 */
export interface PlaneRectangle extends Basis {
  origin: Vector3;
  width: number;
  height: number;
}

/** From the rectangle's first corner. A point beside the plane is put on it along the normal. */
export function inPlane({ origin, p, q }: PlaneRectangle, point: Vector3): InPlane {
  const from = subtract(point, origin);
  return [dot(from, p), dot(from, q)];
}

export const inSample = ({ origin, p, q }: PlaneRectangle, [a, b]: InPlane): Vector3 =>
  along(along(origin, a, p), b, q);

/** The first corner, then along p, and around. */
export const cornersOf = (rectangle: PlaneRectangle): Vector3[] =>
  (
    [
      [0, 0],
      [rectangle.width, 0],
      [rectangle.width, rectangle.height],
      [0, rectangle.height],
    ] as const
  ).map((place) => inSample(rectangle, place));

/** The smallest rectangle along the basis that holds the polygon. */
export function boundingRectangle(polygon: readonly Vector3[], { p, q }: Basis): PlaneRectangle {
  const first = polygon[0]; // from which coordinates are taken, as the tool does
  const coordinates = polygon.map((point) => {
    const from = subtract(point, first);
    return [dot(from, p), dot(from, q)] as const;
  });
  const across = coordinates.map(([a]) => a);
  const down = coordinates.map(([, b]) => b);
  const [left, top] = [Math.min(...across), Math.min(...down)];
  return {
    origin: along(along(first, left, p), top, q),
    p,
    q,
    width: Math.max(...across) - left,
    height: Math.max(...down) - top,
  };
}

/** The basis turned from p towards q. */
export function turnedBasis({ p, q }: Basis, degrees: number): Basis {
  const [cosine, sine] = direction(degrees);
  return {
    p: add(scale(cosine, p), scale(sine, q)),
    q: add(scale(cosine, q), scale(-sine, p)),
  };
}

/** By what angle, in degrees, `axes` is turned from `basis`: 0 where it is not. */
export function angleFrom(basis: Basis, axes: Basis): number {
  const degrees = (Math.atan2(dot(axes.p, basis.q), dot(axes.p, basis.p)) * 180) / Math.PI;
  return Math.abs(degrees) < 1e-9 ? 0 : degrees;
}

/** What of a convex polygon lies in the rectangle (Sutherland and Hodgman 1974). */
export function clippedTo(rectangle: PlaneRectangle, polygon: readonly Vector3[]): Vector3[] {
  const { width, height } = rectangle;
  const sides: ((place: InPlane) => number)[] = [
    ([a]) => a,
    ([a]) => width - a,
    ([, b]) => b,
    ([, b]) => height - b,
  ];
  const inside = sides.reduce(
    (places, room) =>
      places.flatMap((place, i) => {
        const before = places[(i + places.length - 1) % places.length];
        const [here, there] = [room(place), room(before)];
        const kept = here >= 0 ? [place] : [];
        if (here * there >= 0) return kept;
        const part = there / (there - here);
        const crossing: InPlane = [
          before[0] + part * (place[0] - before[0]),
          before[1] + part * (place[1] - before[1]),
        ];
        return [crossing, ...kept];
      }),
    polygon.map((point) => inPlane(rectangle, point)),
  );
  return inside.map((place) => inSample(rectangle, place));
}
