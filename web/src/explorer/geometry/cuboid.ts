import type { Vector3 } from "./vector3";

/**
 * The voxels of a sample in space: voxel (i, j, k) has its centre at (i·Δx, j·Δy, k·Δz), in
 * micrometres. The box goes from the first voxel's centre to the last one's.
 */
export interface Cuboid {
  size: Vector3; // voxels
  spacing: Vector3; // micrometres
}

export const extent = ({ size, spacing }: Cuboid): Vector3 => [
  (size[0] - 1) * spacing[0],
  (size[1] - 1) * spacing[1],
  (size[2] - 1) * spacing[2],
];

export function centre(cuboid: Cuboid): Vector3 {
  const [x, y, z] = extent(cuboid);
  return [x / 2, y / 2, z / 2];
}

export const leastSpacing = ({ spacing }: Cuboid): number => Math.min(...spacing);

/** Corner number: bit 0 is set at the far end along x, bit 1 along y, bit 2 along z. */
export function corners(cuboid: Cuboid): Vector3[] {
  const far = extent(cuboid);
  return Array.from({ length: 8 }, (_, i) => [
    i & 1 ? far[0] : 0,
    i & 2 ? far[1] : 0,
    i & 4 ? far[2] : 0,
  ]);
}

/** Pairs of corner numbers, the one at the lesser coordinate first. */
export const edges: readonly (readonly [number, number])[] = Array.from({ length: 8 }, (_, i) =>
  [1, 2, 4].filter((axis) => (i & axis) === 0).map((axis) => [i, i | axis] as const),
).flat();

/** Layer n lies at (n − 1)·Δz. */
export const depthOfLayer = ({ spacing }: Cuboid, layer: number): number =>
  (layer - 1) * spacing[2];

/** The layer nearest to a depth, of those the sample has. */
export const layerAt = ({ size, spacing }: Cuboid, z: number): number =>
  Math.min(size[2], Math.max(1, Math.round(z / spacing[2]) + 1));
