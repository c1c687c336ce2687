import type { ExplorerState } from "./explorer_state";
import type { Cuboid } from "./geometry/cuboid";
import type { Angles } from "./geometry/plane";
import type { Vector3 } from "./geometry/vector3";
import {
  alongLayers,
  alongXz,
  alongYz,
  diagonal,
  nudged,
  withAngles,
  withNormal,
  withOffset,
  withPoint,
  withThrough,
} from "./plane_state";
import type { PlacedPlane, PlaneDefinition } from "./plane_state";

/**
 * Ways to move the plane that is shown, a series' own while one plays. False tells that there would be
 * no plane: then nothing has changed.
 */

function moveBy(
  state: ExplorerState,
  change: (placed: PlacedPlane, cuboid: Cuboid) => PlaneDefinition,
): boolean {
  const placed = state.shownPlane.value;
  const cuboid = state.cuboid.value;
  return placed !== null && cuboid !== null && state.move(change(placed, cuboid));
}

export const movePoint = (state: ExplorerState, index: number, point: Vector3): boolean =>
  moveBy(state, (placed) => withPoint(placed, index, point));

export const turn = (state: ExplorerState, angles: Partial<Angles>): boolean =>
  moveBy(state, (placed) => {
    const all = { ...placed.angles, ...angles };
    state.azimuth.value = all.azimuth;
    return withAngles(placed, all);
  });

export const setNormal = (state: ExplorerState, normal: Vector3): boolean =>
  moveBy(state, (placed) => withNormal(placed, normal));

export const setThrough = (state: ExplorerState, through: Vector3): boolean =>
  moveBy(state, (placed) => withThrough(placed, through));

/** Micrometres from the sample's origin along the normal. */
export const setOffset = (state: ExplorerState, offset: number): boolean =>
  moveBy(state, (placed, cuboid) => withOffset(placed, offset, cuboid));

/** By so many rows of voxels along its normal. */
export const nudge = (state: ExplorerState, steps: number): boolean =>
  moveBy(state, (placed, cuboid) => nudged(placed, steps, cuboid));

/** The layer nearest to a number that was typed. */
export const toLayer = (state: ExplorerState, layer: number): boolean =>
  moveBy(state, (_, cuboid) =>
    alongLayers(cuboid, Math.min(cuboid.size[2], Math.max(1, Math.round(layer)))),
  );

/** Upright, through the point it is turned about. */
export const stand = (state: ExplorerState, along: "xz" | "yz"): boolean =>
  moveBy(state, ({ through }) => (along === "xz" ? alongXz(through) : alongYz(through)));

export const toDiagonal = (state: ExplorerState): boolean =>
  moveBy(state, (_, cuboid) => diagonal(cuboid, state.depthPresent.value));
