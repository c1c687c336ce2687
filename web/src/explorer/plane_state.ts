import { centre, depthOfLayer, extent, layerAt, corners } from "./geometry/cuboid";
import type { Cuboid } from "./geometry/cuboid";
import {
  anglesOf,
  normalOf,
  planeFromNormal,
  planeThroughPoints,
  range,
  widestTriangle,
} from "./geometry/plane";
import type { Angles, Plane } from "./geometry/plane";
import { sectionPolygon } from "./geometry/section_polygon";
import { along, centroid, dot, scale } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";

export type ThreePoints = readonly [Vector3, Vector3, Vector3];

/** A plane as `biotomy section` takes it. Points are micrometres. */
export type PlaneDefinition =
  { kind: "points"; points: ThreePoints } | { kind: "normal"; normal: Vector3; through: Vector3 };

/** All that the controls show of one plane. Whichever of them moves it, the others follow. */
export interface PlacedPlane {
  definition: PlaneDefinition;
  plane: Plane; // its normal points down into the block, or lies in a layer
  polygon: Vector3[]; // fewer than three vertices when the plane misses the block
  points: ThreePoints; // to be dragged
  angles: Angles;
  offset: number; // of the plane from the sample's origin along the normal
  offsets: [number, number]; // between which it cuts the block
  through: Vector3; // about which it is turned
}

const decimalsOfMicrometres = 3;
const decimalsOfDirections = 6;

const rounded = (value: number, decimals: number): number => Number(value.toFixed(decimals)) + 0;
const tidy = (v: Vector3, decimals = decimalsOfMicrometres): Vector3 => [
  rounded(v[0], decimals),
  rounded(v[1], decimals),
  rounded(v[2], decimals),
];

const within = (value: number, [least, most]: readonly [number, number]): number =>
  Math.min(most, Math.max(least, value));

/** Between which offsets a plane cuts the block; a slanted one only touches it at the very ends. */
function cuttingOffsets(normal: Vector3, cuboid: Cuboid): [number, number] {
  const [least, most] = range(corners(cuboid), normal);
  const slanted = normal.filter((component) => component !== 0).length > 1;
  const margin = slanted ? Math.min(stepAlong(normal, cuboid) / 2, (most - least) / 4) : 0;
  return [least + margin, most - margin];
}

/**
 * None where the definition is of no plane: points on a line, a normal without direction.
 * `azimuth` is taken where the plane lies along the layers and has none.
 */
export function placePlane(
  definition: PlaneDefinition,
  cuboid: Cuboid,
  azimuth = 0,
): PlacedPlane | null {
  const found =
    definition.kind === "points"
      ? planeThroughPoints(definition.points)
      : planeFromNormal(definition.normal, definition.through);
  if (!found) return null;
  const upwards = found.normal[2] < 0;
  const plane = upwards
    ? { normal: scale(-1, found.normal), offset: -found.offset }
    : { normal: found.normal, offset: found.offset };
  const polygon = sectionPolygon(plane, cuboid);
  const cuts = polygon.length >= 3;
  const own = definition.kind === "points" ? definition.points : null;
  const middle = cuts ? centroid(polygon) : centre(cuboid);
  return {
    definition,
    plane,
    polygon,
    points: own ?? (cuts ? widestTriangle(polygon) : pointsBeside(plane, middle)),
    angles: anglesOf(plane.normal, azimuth),
    offset: -plane.offset + 0,
    offsets: cuttingOffsets(plane.normal, cuboid),
    through: definition.kind === "normal" ? definition.through : middle,
  };
}

/** Three points of a plane that misses the block, so that there is something to take hold of. */
function pointsBeside({ normal, offset }: Plane, middle: Vector3): ThreePoints {
  const foot = along(middle, -(dot(normal, middle) + offset), normal);
  const least = normal.map(Math.abs).indexOf(Math.min(...normal.map(Math.abs)));
  const axis = [0, 1, 2].map((i) => (i === least ? 1 : 0)) as unknown as Vector3;
  const first = along(axis, -dot(axis, normal), normal);
  const reach = Math.max(...middle, 1);
  const second: Vector3 = [
    normal[1] * first[2] - normal[2] * first[1],
    normal[2] * first[0] - normal[0] * first[2],
    normal[0] * first[1] - normal[1] * first[0],
  ];
  return [foot, along(foot, reach, first), along(foot, reach, second)];
}

/** How far the plane moves along its normal from one row of voxels to the next. */
export const stepAlong = (normal: Vector3, { spacing }: Cuboid): number =>
  Math.hypot(normal[0] * spacing[0], normal[1] * spacing[1], normal[2] * spacing[2]);

/** One of its three points elsewhere; the others stay. */
export function withPoint(placed: PlacedPlane, index: number, point: Vector3): PlaneDefinition {
  const points = placed.points.map((old, i) => tidy(i === index ? point : old));
  return { kind: "points", points: points as unknown as ThreePoints };
}

/** Turned about the point it goes through. */
export function withAngles(placed: PlacedPlane, angles: Angles): PlaneDefinition {
  const normal = tidy(normalOf(angles), decimalsOfDirections);
  return { kind: "normal", normal, through: tidy(placed.through) };
}

export function withNormal(placed: PlacedPlane, normal: Vector3): PlaneDefinition {
  return { kind: "normal", normal, through: tidy(placed.through) };
}

/** As it was typed, where a point was; its normal stays. */
export function withThrough({ definition, plane }: PlacedPlane, through: Vector3): PlaneDefinition {
  const normal = definition.kind === "normal" ? definition.normal : plane.normal;
  return { kind: "normal", normal, through };
}

/** Moved along its normal, as far as it still cuts the block; three points move with it. */
export function withOffset(placed: PlacedPlane, offset: number, cuboid: Cuboid): PlaneDefinition {
  const { normal } = placed.plane;
  const asked = within(offset, placed.offsets);
  if (placed.definition.kind === "points") {
    const points = placed.points.map((point) =>
      tidy(along(point, asked - placed.offset, normal)),
    ) as unknown as ThreePoints;
    if (points.every((point) => isNear(point, cuboid))) return { kind: "points", points };
  }
  const moved = rounded(asked, decimalsOfMicrometres);
  // Turning it later about the middle of what it cuts never takes it off the block.
  const polygon = sectionPolygon({ normal, offset: -moved }, cuboid);
  const from = polygon.length >= 3 ? centroid(polygon) : placed.through;
  const through = along(from, moved - dot(normal, from), normal);
  return { kind: "normal", normal: tidy(normal, decimalsOfDirections), through: tidy(through) };
}

/** The plane by itself, in numbers that people can read; a depth along the layers stays exact. */
export function tidied({ plane, polygon, through, offset }: PlacedPlane): PlaneDefinition {
  const [x, y, z] = tidy(polygon.length < 3 ? through : centroid(polygon));
  return {
    kind: "normal",
    normal: tidy(plane.normal, decimalsOfDirections),
    through: [x, y, isAlongLayers(plane) ? offset : z],
  };
}

const spare = 0.1; // of the block: points on its faces, too, may be moved off them

/** In the block, or no farther beside it than one can take hold of. */
function isNear(point: Vector3, cuboid: Cuboid): boolean {
  const far = extent(cuboid);
  const room = spare * Math.max(...far);
  return point.every((value, i) => value >= -room && value <= far[i] + room);
}

/** By so many rows of voxels along its normal; a plane along the layers goes from layer to layer. */
export function nudged(placed: PlacedPlane, steps: number, cuboid: Cuboid): PlaneDefinition {
  if (isAlongLayers(placed.plane)) {
    const layer = layerAt(cuboid, placed.offset) + steps;
    return alongLayers(cuboid, within(layer, [1, cuboid.size[2]]));
  }
  return withOffset(placed, placed.offset + steps * stepAlong(placed.plane.normal, cuboid), cuboid);
}

export const isAlongLayers = ({ normal }: Plane): boolean => normal[0] === 0 && normal[1] === 0;

/** The section along a layer is the layer's image itself: its depth is not rounded. */
export function alongLayers(cuboid: Cuboid, layer: number): PlaneDefinition {
  const [x, y] = tidy(centre(cuboid));
  return { kind: "normal", normal: [0, 0, 1], through: [x, y, depthOfLayer(cuboid, layer)] };
}

/** Upright, rows along x. */
export const alongXz = (through: Vector3): PlaneDefinition => ({
  kind: "normal",
  normal: [0, 1, 0],
  through: tidy(through),
});

/** Upright, rows along y. */
export const alongYz = (through: Vector3): PlaneDefinition => ({
  kind: "normal",
  normal: [1, 0, 0],
  through: tidy(through),
});

/** From the upper edge of the front face to the edge opposite, at a depth. */
export function diagonal(cuboid: Cuboid, depth: number): PlaneDefinition {
  const [x, y] = extent(cuboid);
  return {
    kind: "points",
    points: [
      [0, 0, 0],
      [x, 0, 0],
      [x, y, depth],
    ],
  };
}
