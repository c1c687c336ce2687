import { corners, edges } from "./geometry/cuboid";
import { clippedTo, inPlane } from "./geometry/plane_rectangle";
import { dot } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import type { Projection } from "./orbit_camera";
import { rectangleOf } from "./section_record";
import type { SectionPicture } from "./section_record";

/** What is drawn of the block and its section. Lengths are micrometres. */
export interface CuboidScene {
  projection: Projection;
  far: Vector3; // the corner opposite to the origin
  depthPresent: number; // of the newest face: below it, nothing is known yet
  picture: SectionPicture | null; // lies in the plane that it was cut from
  polygon: readonly Vector3[];
  colours: SceneColours;
}

export interface SceneColours {
  line: string;
  missing: string; // not ground yet
  plane: string;
}

/** Draws a scene when it is told to, and never by itself. */
export interface CuboidRenderer {
  draw(scene: CuboidScene, ratio: number): void;
  dispose(): void;
}

type Segment = readonly [Vector3, Vector3];

/** The box's edges, those parted that the block itself hides. */
export function boxEdges(
  far: Vector3,
  towards: Vector3,
): { visible: Segment[]; hidden: Segment[] } {
  const points = corners({ size: [2, 2, 2], spacing: far });
  // The corner that is farthest away is behind three faces, if it is alone.
  const depths = points.map((point) => dot(point, towards));
  const deepest = Math.min(...depths);
  const tolerance = 1e-9 * Math.hypot(...far);
  const behind = depths.filter((depth) => depth <= deepest + tolerance).length > 1;
  const hidden: Segment[] = [];
  const visible: Segment[] = [];
  for (const [i, j] of edges) {
    const atDeepest = Math.min(depths[i], depths[j]) <= deepest + tolerance;
    (atDeepest && !behind ? hidden : visible).push([points[i], points[j]]);
  }
  return { visible, hidden };
}

/** Faces of the box between two depths, as rectangles; those alone that are turned to the viewer. */
export function facesTowards(
  [x, y]: Vector3,
  [above, below]: readonly [number, number],
  towards: Vector3,
): Vector3[][] {
  const box = (i: number): Vector3 => [i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? below : above];
  const faces = [
    { axis: 0, far: false, corners: [0, 2, 6, 4] },
    { axis: 0, far: true, corners: [1, 3, 7, 5] },
    { axis: 1, far: false, corners: [0, 1, 5, 4] },
    { axis: 1, far: true, corners: [2, 3, 7, 6] },
    { axis: 2, far: false, corners: [0, 1, 3, 2] },
    { axis: 2, far: true, corners: [4, 5, 7, 6] },
  ];
  return faces
    .filter(({ axis, far }) => (far ? towards[axis] > 1e-9 : towards[axis] < -1e-9))
    .map((face) => face.corners.map(box));
}

/** The part of the section that the picture covers, each vertex with its place in the picture. */
export function texturedPolygon({
  record,
}: SectionPicture): { point: Vector3; u: number; v: number }[] {
  const rectangle = rectangleOf(record);
  return clippedTo(rectangle, record.polygon_um).map((point) => {
    const [a, b] = inPlane(rectangle, point);
    return {
      point,
      u: (a / record.pixel_um + 0.5) / record.picture.width,
      v: (b / record.pixel_um + 0.5) / record.picture.height,
    };
  });
}

const roomForLabel = 60; // along an edge, pixels
/** Of the middles of two labels, or of a label and a handle: nearer ones overlap, pixels. */
const besideLabel = [60, 16] as const;
const besideHandle = [39, 17] as const;
const push = 20; // pixels
const mostPushes = 4;

type Place = readonly [number, number];

const overlaps = (x: number, y: number, [ox, oy]: Place, [width, height]: Place): boolean =>
  Math.abs(x - ox) < width && Math.abs(y - oy) < height;

/**
 * A label outside the middle of the lowest of the edges that an axis has on the screen; below the
 * end of one that is too short for it. It makes way outwards for handles and for other labels.
 */
export function axisLabels(
  far: Vector3,
  project: (point: Vector3) => Place,
  handles: readonly Place[] = [],
): { axis: 0 | 1 | 2; x: number; y: number }[] {
  const points = corners({ size: [2, 2, 2], spacing: far });
  const [middleX, middleY] = project([far[0] / 2, far[1] / 2, far[2] / 2]);
  const taken: Place[] = [];
  return ([0, 1, 2] as const).map((axis) => {
    const bit = 1 << axis;
    const places = edges
      .filter(([i, j]) => (i ^ j) === bit)
      .map(([i, j]) => {
        const [a, b] = [project(points[i]), project(points[j])];
        const short = Math.hypot(a[0] - b[0], a[1] - b[1]) < roomForLabel;
        const lower = a[1] > b[1] ? a : b;
        return short
          ? { x: lower[0], y: lower[1] }
          : { x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2 };
      });
    const outward = ({ x, y }: { x: number; y: number }) =>
      Math.hypot(x - middleX, y - middleY) + 0.6 * (y - middleY) + 0.2 * (x - middleX);
    const best = places.reduce((a, b) => (outward(b) > outward(a) + 1e-6 ? b : a));
    const away = Math.hypot(best.x - middleX, best.y - middleY) || 1;
    const [right, down] = [(best.x - middleX) / away, (best.y - middleY) / away];
    let [x, y] = [best.x + 22 * right, best.y + 18 * down];
    const isTaken = () =>
      handles.some((place) => overlaps(x, y, place, besideHandle)) ||
      taken.some((place) => overlaps(x, y, place, besideLabel));
    for (let pushes = 0; pushes < mostPushes && isTaken(); pushes += 1) {
      x += push * right;
      y += push * down;
    }
    taken.push([x, y]);
    return { axis, x, y };
  });
}
