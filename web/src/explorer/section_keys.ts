import { arrows, moveByArrow } from "./arrow_keys";
import type { ExplorerState } from "./explorer_state";
import { pressedWhileMeasuring } from "./measure_cross";
import { nudge } from "./plane_moves";
import type { SectionTools } from "./section_tools";
import { movedBy } from "./section_window";
import { toFullResolution, zoomAbout } from "./section_zoom";

/** What the keys do, for those who can't see what is under their hands. */
export const sectionKeys =
  "Arrow up and down move the plane by a step, page up and page down by ten. Plus and " +
  "minus zoom, 1 shows a voxel a pixel, 0 shows all of it; in a close-up, arrow keys move what is " +
  "seen. While measuring, arrow keys move a cross, and Enter takes its place.";

export function pressedOnSection(
  event: KeyboardEvent,
  state: ExplorerState,
  tools: SectionTools,
): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const arrow = arrows[event.key];
  const window = state.window.value;
  const measuring = tools.tool.value === "measure";
  if (measuring && pressedWhileMeasuring(event, state, tools)) return event.preventDefault();
  if (arrow && state.closeup.value && window) {
    const step = window.width / 16;
    state.closeup.value = movedBy(window, arrow[0] * step, arrow[1] * step);
  } else if (arrow) moveByArrow(state, arrow);
  else if (event.key === "+" || event.key === "=") zoomAbout(state, 1.5);
  else if (event.key === "-") zoomAbout(state, 1 / 1.5);
  else if (event.key === "1") toFullResolution(state);
  else if (event.key === "0") state.closeup.value = null;
  else if (event.key === "PageDown") nudge(state, 10);
  else if (event.key === "PageUp") nudge(state, -10);
  else if (event.key === "Escape" && tools.tool.value !== "look") tools.take("look");
  else return;
  event.preventDefault();
}
