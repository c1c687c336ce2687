import { useEffect } from "preact/hooks";

import type { ExplorerState } from "./explorer_state";
import { Fingers } from "./fingers";
import { cornersOf, inPlane, turnedBasis } from "./geometry/plane_rectangle";
import { sectionBasis } from "./geometry/section_basis";
import type { Vector3 } from "./geometry/vector3";
import { chooseEdge, edgeUnder } from "./section_edge";
import type { SectionTools } from "./section_tools";
import { movedBy, pixelAt, sampleAtPixel } from "./section_window";
import type { SectionWindow } from "./section_window";
import { zoomAbout } from "./section_zoom";
import { customBetween } from "./theta_frame";

const reach = 20; // CSS pixels, how near to a corner a press takes hold of it
const leastDrag = 4;

type Place = [number, number];

/** Mouse and fingers on the section: they look closer, measure, draw the rectangle or choose it. */
export function useSectionPointer(
  box: { current: HTMLDivElement | null },
  state: ExplorerState,
  tools: SectionTools,
  draft: { value: [Vector3, Vector3] | null },
): void {
  useEffect(() => {
    const element = box.current!;
    const fingers = new Fingers();
    let opposite: Vector3 | null = null; // of the rectangle's corner that is being moved
    let pressedAt: Place | null = null;

    const at = (event: PointerEvent | WheelEvent | MouseEvent): Place => {
      const { left, top } = element.getBoundingClientRect();
      return [event.clientX - left, event.clientY - top];
    };
    const onScreen = ([x, y]: Place): Place => [
      x * state.panel.value.ratio,
      y * state.panel.value.ratio,
    ];
    const toScreen = (window: SectionWindow, point: Vector3): Place => {
      const [x, y] = pixelAt(window, inPlane(window.frame, point));
      return [x / state.panel.value.ratio, y / state.panel.value.ratio];
    };
    const placeOf = (place: Place): Vector3 | null => {
      const window = state.window.value;
      return window && sampleAtPixel(window, ...onScreen(place));
    };
    const oppositeOfCorner = ([x, y]: Place): Vector3 | null => {
      const window = state.window.value;
      const rectangle = state.rectangle.value;
      const custom = state.choices.value.theta.kind === "custom" && state.around.value;
      if (!window || !rectangle || !custom) return null;
      const corners = cornersOf(rectangle);
      const distances = corners.map((corner) => {
        const [cx, cy] = toScreen(window, corner);
        return Math.hypot(cx - x, cy - y);
      });
      const least = Math.min(...distances);
      return least > reach ? null : corners[(distances.indexOf(least) + 2) % 4];
    };
    const edgeAt = (place: Place, { pointerType }: PointerEvent): number | null => {
      const window = state.window.value;
      if (!window || tools.tool.value !== "look") return null;
      return edgeUnder(state, (point) => toScreen(window, point), place, pointerType);
    };
    const moveCorner = (from: Vector3, to: Vector3) => {
      const placed = state.placed.value;
      const { theta, basis } = state.choices.value;
      if (!placed) return;
      const angle = theta.kind === "custom" ? theta.angle : 0;
      const axes = turnedBasis(sectionBasis(basis, placed.plane), angle);
      const custom = customBetween(axes, angle, from, to);
      if (custom) state.choose({ theta: custom });
    };

    const down = (event: PointerEvent) => {
      if (event.button !== 0) return;
      const place = at(event);
      element.setPointerCapture(event.pointerId);
      fingers.down(event.pointerId, ...place);
      pressedAt = place;
      if (fingers.count > 1) {
        draft.value = null;
        return;
      }
      opposite = oppositeOfCorner(place);
      const point = placeOf(place);
      if (!opposite && tools.tool.value === "rectangle" && point) draft.value = [point, point];
    };
    const move = (event: PointerEvent) => {
      const place = at(event);
      tools.pointer.value = place;
      element.classList.toggle("over-edge", fingers.count === 0 && edgeAt(place, event) !== null);
      const moved = fingers.move(event.pointerId, ...place);
      const window = state.window.value;
      if (!moved || !window || state.frame.value) return;
      const point = placeOf(place);
      if (opposite && point) moveCorner(opposite, point);
      else if (draft.value && point) draft.value = [draft.value[0], point];
      else {
        if (moved.factor !== 1) {
          zoomAbout(state, moved.factor, onScreen(moved.middle));
        }
        if (state.closeup.value && state.window.value) {
          const [right, down] = onScreen([moved.right, moved.down]);
          state.closeup.value = movedBy(state.window.value, -right, -down);
        }
      }
    };
    const up = (event: PointerEvent) => {
      const place = at(event);
      const clicked =
        pressedAt !== null &&
        fingers.count === 1 &&
        Math.hypot(place[0] - pressedAt[0], place[1] - pressedAt[1]) < leastDrag;
      fingers.up(event.pointerId);
      if (draft.value) {
        const ends = draft.value;
        draft.value = null;
        if (!clicked && event.type === "pointerup") {
          state.around.value = true;
          const placed = state.placed.value;
          const custom =
            placed &&
            customBetween(sectionBasis(state.choices.value.basis, placed.plane), 0, ...ends);
          if (custom) state.choose({ theta: custom });
          tools.take("look");
        }
      } else if (clicked && event.type === "pointerup") {
        const point = tools.tool.value === "measure" ? state.sampleUnder(place) : null;
        const edge = opposite ? null : edgeAt(place, event);
        if (point) tools.measure(point);
        else if (edge !== null) chooseEdge(state, edge);
      }
      opposite = null;
      pressedAt = null;
    };
    const left = () => (tools.pointer.value = null);
    const wheel = (event: WheelEvent) => {
      event.preventDefault();
      zoomAbout(state, Math.exp(-event.deltaY / 400), onScreen(at(event)));
    };
    const twice = (event: MouseEvent) => {
      if (tools.tool.value === "look") zoomAbout(state, 2, onScreen(at(event)));
    };
    element.addEventListener("pointerdown", down);
    element.addEventListener("pointermove", move);
    element.addEventListener("pointerup", up);
    element.addEventListener("pointercancel", up);
    element.addEventListener("pointerleave", left);
    element.addEventListener("wheel", wheel, { passive: false });
    element.addEventListener("dblclick", twice);
    return () => {
      element.removeEventListener("pointerdown", down);
      element.removeEventListener("pointermove", move);
      element.removeEventListener("pointerup", up);
      element.removeEventListener("pointercancel", up);
      element.removeEventListener("pointerleave", left);
      element.removeEventListener("wheel", wheel);
      element.removeEventListener("dblclick", twice);
    };
  }, []);
}
