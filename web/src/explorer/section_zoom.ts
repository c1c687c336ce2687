import type { ExplorerState } from "./explorer_state";
import { leastSpacing } from "./geometry/cuboid";
import { zoomedAt } from "./section_window";

/** Why there is no zoom, for who looks for it. */
export const noZoom = "Not while a series is open: Cut here first.";

/** A voxel, a pixel. */
export function toFullResolution(state: ExplorerState): void {
  const window = state.window.value;
  const cuboid = state.cuboid.value;
  if (window && cuboid) zoomAbout(state, window.pixel / leastSpacing(cuboid));
}

/** Zooms about a place of the panel, in pixels of the screen; by itself about the middle. */
export function zoomAbout(state: ExplorerState, factor: number, place?: [number, number]): void {
  const window = state.window.value;
  const cuboid = state.cuboid.value;
  if (!window || !cuboid || state.frame.value) return;
  const middle: [number, number] = place ?? [window.width / 2, window.height / 2];
  state.closeup.value = zoomedAt(window, factor, middle, leastSpacing(cuboid));
}
