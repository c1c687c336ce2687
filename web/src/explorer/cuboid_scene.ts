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
