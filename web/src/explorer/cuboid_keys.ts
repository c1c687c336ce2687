import type { Signal } from "@preact/signals";

import { arrows, moveByArrow } from "./arrow_keys";
import { surfaceUnder } from "./box_surface";
import type { ExplorerState } from "./explorer_state";
import { orbited, projected, startingCamera, zoomed } from "./orbit_camera";
import type { Projection } from "./orbit_camera";
import { movePoint, nudge } from "./plane_moves";

/** What the keys do, for those who can't see what is under their hands. */
export const cuboidKeys =
  "Arrow up and down move the plane by a step, page up and page down by ten, " +
  "arrow left and right tilt it. With Shift, arrow keys turn the view; plus and minus zoom, 0 " +
  "starts anew. Keys 1, 2 and 3 choose a point of the plane, which the arrow keys then move; " +
  "Escape lets it go.";

export function pressedOnCuboid(
  event: KeyboardEvent,
  state: ExplorerState,
  view: Projection,
  held: Signal<number | null>,
): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const arrow = arrows[event.key];
  if (arrow && held.value !== null) {
    movePointBy(state, view, held.value, arrow, event.shiftKey ? 20 : 2);
  } else if (arrow && event.shiftKey) {
    state.camera.value = orbited(state.camera.value, 5 * arrow[0], 5 * arrow[1]);
  } else if (arrow) moveByArrow(state, arrow);
  else if (["1", "2", "3"].includes(event.key)) held.value = Number(event.key) - 1;
  else if (event.key === "Escape" && held.value !== null) held.value = null;
  else if (event.key === "+" || event.key === "=") {
    state.camera.value = zoomed(state.camera.value, 1.25);
  } else if (event.key === "-") state.camera.value = zoomed(state.camera.value, 0.8);
  else if (event.key === "0") state.camera.value = startingCamera;
  else if (event.key === "PageDown") nudge(state, 10);
  else if (event.key === "PageUp") nudge(state, -10);
  else return;
  event.preventDefault();
}

function movePointBy(
  state: ExplorerState,
  view: Projection,
  index: number,
  [right, down]: [number, number],
  pixels: number,
): void {
  const point = state.shownPlane.value?.points[index];
  if (!point) return;
  const [x, y] = projected(view, point);
  const wanted: [number, number] = [x + right * pixels, y + down * pixels];
  movePoint(state, index, surfaceUnder(view, wanted, state.far.value, point));
}
