import { corners, edges, extent } from "./cuboid";
import type { Cuboid } from "./cuboid";
import { signedDistance } from "./plane";
import type { Plane } from "./plane";
import { along, centroid, cross, dot, inOrder, norm, scale, subtract } from "./vector3";
import type { Vector3 } from "./vector3";

// Of the box's diagonal, as in reconstruct/geometry/section_polygon.
const onPlane = 1e-13;
const samePoint = 1e-11;

/**
 * What the plane and the box have in common: 3 to 6 vertices in the order of the server's
 * `polygon_um` when the plane cuts the box, fewer when it touches or misses it. Shown while the
 * hand moves; what is cut is the server's.
 */
export function sectionPolygon(plane: Plane, cuboid: Cuboid): Vector3[] {
  const diagonal = norm(extent(cuboid));
  const points = corners(cuboid);
  const distances = points.map((point) => {
    const distance = signedDistance(plane, point);
    return Math.abs(distance) <= onPlane * diagonal ? 0 : distance;
  });
  const vertices: Vector3[] = [];
  const addUnlessThere = (point: Vector3) => {
    const there = vertices.some((other) => norm(subtract(point, other)) <= samePoint * diagonal);
    if (!there) vertices.push(point);
  };
  points.forEach((point, i) => distances[i] === 0 && addUnlessThere(point));
  for (const [i, j] of edges) {
    const [a, b] = [distances[i], distances[j]];
    if (a * b < 0) {
      addUnlessThere(along(points[i], a / (a - b), subtract(points[j], points[i])));
    }
  }
  return vertices.length < 3 ? vertices : aroundCentre(vertices, plane.normal);
}

function aroundCentre(vertices: Vector3[], normal: Vector3): Vector3[] {
  const first = vertices.reduce((least, point) => (inOrder(point, least) < 0 ? point : least));
  const middle = centroid(vertices);
  const zero = subtract(first, middle);
  const quarter = cross(inOrder(normal, [0, 0, 0]) < 0 ? scale(-1, normal) : normal, zero);
  const angle = (point: Vector3) => {
    const from = subtract(point, middle);
    const around = Math.atan2(dot(from, quarter), dot(from, zero));
    return around < 0 ? around + 2 * Math.PI : around;
  };
  const others = vertices.filter((point) => point !== first);
  return [first, ...others.sort((a, b) => angle(a) - angle(b))];
}
