import { corners, edges } from "./geometry/cuboid";
import type { Vector3 } from "./geometry/vector3";

/** A place of the screen, pixels. */
type Place = readonly [number, number];

export interface AxisLabel {
  axis: 0 | 1 | 2;
  x: number;
  y: number;
}

const roomForLabel = 60; // along an edge, pixels
/** Of the middles of two labels, or of a label and a handle: nearer ones overlap. */
const besideLabel: Place = [60, 16];
const besideHandle: Place = [39, 17];
const ways = [20, 40, 60]; // that a label makes way for others

/**
 * A label outside the middle of the lowest of the edges that an axis has on the screen; below the
 * end of one that is too short for it. It makes way for handles and for other labels: outwards, or
 * up and down where the view ends. `held`: the place in the view that is nearest to one.
 */
export function axisLabels(
  far: Vector3,
  project: (point: Vector3) => Place,
  handles: readonly Place[] = [],
  held: (place: Place) => Place = (place) => place,
): AxisLabel[] {
  const middle = project([far[0] / 2, far[1] / 2, far[2] / 2]);
  const labels: Place[] = [];
  const isFree = (place: Place) =>
    !handles.some((handle) => overlap(place, handle, besideHandle)) &&
    !labels.some((label) => overlap(place, label, besideLabel));
  return ([0, 1, 2] as const).map((axis) => {
    const [x, y] = edgePlace(axis, far, project, middle);
    const away = Math.hypot(x - middle[0], y - middle[1]) || 1;
    const [right, down] = [(x - middle[0]) / away, (y - middle[1]) / away];
    const [first, ...others] = [
      [x + 22 * right, y + 18 * down] as const,
      ...ways.map((way) => [x + (22 + way) * right, y + (18 + way) * down] as const),
      ...ways.flatMap((way) => [[x, y + way] as const, [x, y - way] as const]),
    ].map(held);
    const place = [first, ...others].find(isFree) ?? first;
    labels.push(place);
    return { axis, x: place[0], y: place[1] };
  });
}

const overlap = (one: Place, other: Place, [width, height]: Place): boolean =>
  Math.abs(one[0] - other[0]) < width && Math.abs(one[1] - other[1]) < height;

/** What the label is of: the middle of the edge, or its lower end. */
function edgePlace(
  axis: 0 | 1 | 2,
  far: Vector3,
  project: (point: Vector3) => Place,
  [middleX, middleY]: Place,
): Place {
  const points = corners({ size: [2, 2, 2], spacing: far });
  const places = edges
    .filter(([i, j]) => (i ^ j) === 1 << axis)
    .map(([i, j]): Place => {
      const [a, b] = [project(points[i]), project(points[j])];
      const isShort = Math.hypot(a[0] - b[0], a[1] - b[1]) < roomForLabel;
      if (isShort) return a[1] > b[1] ? a : b;
      return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    });
  const outward = ([x, y]: Place) =>
    Math.hypot(x - middleX, y - middleY) + 0.6 * (y - middleY) + 0.2 * (x - middleX);
  return places.reduce((a, b) => (outward(b) > outward(a) + 1e-6 ? b : a));
}
