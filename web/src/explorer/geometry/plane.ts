import { cross, direction, dot, inOrder, norm, scale, subtract } from "./vector3";
import type { Vector3 } from "./vector3";

/** normal·x + offset = 0, the normal of length 1 and the offset in micrometres. */
export interface Plane {
  normal: Vector3;
  offset: number;
}

/** Components of a normal below this are taken for rounding errors, as the tool takes them. */
const negligibleComponent = 1e-11;
/** Of a triangle's longest side: flatter ones are lines to the tool; here it has room to spare. */
const flatTriangle = 1e-6;

function unit(v: Vector3): Vector3 {
  const largest = Math.max(...v.map(Math.abs));
  const scaled = v.map((component) => {
    const part = component / largest;
    return Math.abs(part) < negligibleComponent ? 0 : part;
  }) as unknown as Vector3;
  return scale(1 / norm(scaled), scaled);
}

/** None where the normal is no direction. */
export function planeFromNormal(normal: Vector3, through: Vector3): Plane | null {
  const length = norm(normal);
  if (!Number.isFinite(length) || length === 0 || !through.every(Number.isFinite)) return null;
  const direction = unit(normal);
  return { normal: direction, offset: -dot(direction, through) };
}

/** None where the points lie on a line, nearly. Their order makes no difference. */
export function planeThroughPoints(points: readonly Vector3[]): Plane | null {
  const [a, b, c] = [...points].sort(inOrder) as [Vector3, Vector3, Vector3];
  const sides = [subtract(b, a), subtract(c, a), subtract(c, b)];
  const longest = Math.max(...sides.map(norm));
  if (!Number.isFinite(longest) || longest === 0) return null;
  const normal = cross(scale(1 / longest, sides[0]), scale(1 / longest, sides[1]));
  return norm(normal) < flatTriangle ? null : planeFromNormal(normal, a);
}

export const signedDistance = ({ normal, offset }: Plane, point: Vector3): number =>
  dot(normal, point) + offset;

/** How a plane stands, in degrees. */
export interface Angles {
  tilt: number; // between the normal and z: 0 along the layers, 90 upright
  azimuth: number; // of the normal about z, from x towards y; −180 to 180
}

/** Right angles give exact normals. */
export function normalOf({ tilt, azimuth }: Angles): Vector3 {
  const [down, across] = direction(tilt);
  const [x, y] = direction(azimuth);
  return [across * x, across * y, down];
}

/** A tilt of 0 to 90; where it is 0 there is no azimuth, and `azimuth` is returned. */
export function anglesOf(normal: Vector3, azimuth = 0): Angles {
  const upwards = normal[2] < 0;
  const [x, y, z] = upwards ? scale(-1, normal) : normal;
  const across = Math.hypot(x, y);
  const degrees = 180 / Math.PI;
  return {
    tilt: Math.atan2(across, z) * degrees,
    azimuth: across === 0 ? azimuth : Math.atan2(y, x) * degrees,
  };
}

/** The least and the greatest coordinate of `points` along a direction. */
export function range(points: readonly Vector3[], along: Vector3): [number, number] {
  const coordinates = points.map((point) => dot(point, along));
  return [Math.min(...coordinates), Math.max(...coordinates)];
}

/** The three of the polygon's vertices that make the largest triangle. */
export function widestTriangle(polygon: readonly Vector3[]): [Vector3, Vector3, Vector3] {
  let widest: [Vector3, Vector3, Vector3] = [polygon[0], polygon[1], polygon[2]];
  let most = -1;
  polygon.forEach((a, i) => {
    polygon.slice(i + 1).forEach((b, j) => {
      for (const c of polygon.slice(i + j + 2)) {
        const area = norm(cross(subtract(b, a), subtract(c, a)));
        // A plain rectangle has four equal ones: rounding must not choose among them.
        if (area > most * (1 + 1e-9)) {
          most = area;
          widest = [a, b, c];
        }
      }
    });
  });
  return widest;
}
