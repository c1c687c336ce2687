import { arrows } from "./arrow_keys";
import type { ExplorerState } from "./explorer_state";
import type { SectionTools } from "./section_tools";

const step = 16; // CSS pixels, a single one with Shift

/** Where a distance is measured by keys: it begins in the middle, and goes where the pointer goes. */
export function crossOf(state: ExplorerState, tools: SectionTools): readonly [number, number] {
  const { width, height, ratio } = state.panel.value;
  return tools.pointer.value ?? [width / ratio / 2, height / ratio / 2];
}

/** False for a key that has nothing to do with measuring. */
export function pressedWhileMeasuring(
  { key, shiftKey }: KeyboardEvent,
  state: ExplorerState,
  tools: SectionTools,
): boolean {
  const [x, y] = crossOf(state, tools);
  const arrow = arrows[key];
  if (arrow) {
    const { width, height, ratio } = state.panel.value;
    const [right, down] = arrow.map((part) => part * (shiftKey ? 1 : step));
    tools.pointer.value = [
      Math.min(width / ratio, Math.max(0, x + right)),
      Math.min(height / ratio, Math.max(0, y + down)),
    ];
  } else if (key === "Enter") {
    const place = state.sampleUnder([x, y]);
    if (place) tools.measure(place);
  } else return false;
  return true;
}
