import type { Vector3 } from "./geometry/vector3";
import { along, dot, scale, subtract } from "./geometry/vector3";
import { unprojected } from "./orbit_camera";
import type { Projection } from "./orbit_camera";

/** Where a line enters the box from (0, 0, 0) to `far`, and where it leaves it. */
export function crossings(
  start: Vector3,
  direction: Vector3,
  far: Vector3,
): [Vector3, Vector3] | null {
  let [enter, leave] = [-Infinity, Infinity];
  for (const axis of [0, 1, 2] as const) {
    if (direction[axis] === 0) {
      if (start[axis] < 0 || start[axis] > far[axis]) return null;
      continue;
    }
    const a = -start[axis] / direction[axis];
    const b = (far[axis] - start[axis]) / direction[axis];
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  if (enter > leave) return null;
  return [
    intoBox(along(start, enter, direction), far),
    intoBox(along(start, leave, direction), far),
  ];
}

/** The nearest point of the box: what lies in it stays. */
const intoBox = (point: Vector3, far: Vector3): Vector3 => [
  Math.min(far[0], Math.max(0, point[0])),
  Math.min(far[1], Math.max(0, point[1])),
  Math.min(far[2], Math.max(0, point[2])),
];

/**
 * The point of the box's surface under a line of sight, on the side that is nearer to `before`, so
 * that a point taken hold of on the back stays on the back. Beside the box it is the nearest point
 * of its outline. `away` points from the viewer, with length 1.
 */
export function surfacePoint(
  start: Vector3,
  away: Vector3,
  far: Vector3,
  before: Vector3,
): Vector3 {
  const hit = crossings(start, away, far);
  if (hit) {
    const depth = (point: Vector3) => Math.abs(dot(subtract(point, before), away));
    return depth(hit[0]) <= depth(hit[1]) ? hit[0] : hit[1];
  }
  return nearestToLine(start, away, far);
}

/**
 * Alternately the nearest point of the box to the line and of the line to the box: two convex sets,
 * so it comes to the nearest pair (von Neumann's projections).
 */
function nearestToLine(start: Vector3, direction: Vector3, far: Vector3): Vector3 {
  let point = intoBox(start, far);
  for (let i = 0; i < 60; ++i) {
    const onLine = along(start, dot(subtract(point, start), direction), direction);
    point = intoBox(onLine, far);
  }
  return point;
}

/** The point of the surface under a place of the screen: `surfacePoint` along the line of sight. */
export function surfaceUnder(
  view: Projection,
  at: readonly [number, number],
  far: Vector3,
  before: Vector3,
): Vector3 {
  return surfacePoint(unprojected(view, at), scale(-1, view.axes.towards), far, before);
}
