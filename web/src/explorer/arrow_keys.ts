import type { ExplorerState } from "./explorer_state";
import { nudge, turn } from "./plane_moves";

/** Right and down, of each arrow key. */
export const arrows: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** Up and down by a step along its normal, left and right by a degree of tilt. */
export function moveByArrow(state: ExplorerState, [right, down]: [number, number]): void {
  if (down !== 0) nudge(state, down);
  const tilt = state.shownPlane.value?.angles.tilt ?? 0;
  if (right !== 0) turn(state, { tilt: Math.min(90, Math.max(0, tilt + right)) });
}
