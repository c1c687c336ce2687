import type { ReadonlySignal, Signal } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { surfaceUnder } from "./box_surface";
import type { ExplorerState } from "./explorer_state";
import { Fingers } from "./fingers";
import type { Vector3 } from "./geometry/vector3";
import { orbited, projected, zoomed } from "./orbit_camera";
import type { Projection } from "./orbit_camera";
import { movePoint } from "./plane_moves";
import { chooseEdge, edgeUnder } from "./section_edge";

const degreesPerPixel = 0.5;
const reach = { mouse: 16, touch: 28 }; // how near to a point a press takes hold of it, CSS pixels
const leastDrag = 4;

/**
 * Mouse and fingers on the block: they move the plane's points, turn the view and zoom it, and
 * choose the rectangle on an edge of the section.
 */
export function useCuboidPointer(
  canvas: { current: HTMLCanvasElement | null },
  state: ExplorerState,
  projection: ReadonlySignal<Projection>,
  handles: ReadonlySignal<[number, number][]>,
  held: Signal<number | null>,
): void {
  useEffect(() => {
    const element = canvas.current!;
    const fingers = new Fingers();
    let grip: [number, number] = [0, 0]; // from the pointer to the point it holds
    let last: Vector3 = [0, 0, 0];
    let pressedAt: [number, number] | null = null; // where there is nothing to take hold of

    const at = (event: PointerEvent | WheelEvent): [number, number] => {
      const { left, top } = element.getBoundingClientRect();
      return [event.clientX - left, event.clientY - top];
    };
    const nearest = ([x, y]: [number, number], limit: number): number | null => {
      const distances = handles.value.map(([hx, hy]) => Math.hypot(hx - x, hy - y));
      const least = Math.min(...distances);
      return least <= limit ? distances.indexOf(least) : null;
    };
    const limitOf = (event: PointerEvent) =>
      event.pointerType === "mouse" ? reach.mouse : reach.touch;
    const edgeAt = (place: [number, number], { pointerType }: PointerEvent) =>
      edgeUnder(state, (point) => projected(projection.value, point), place, pointerType);

    const down = (event: PointerEvent) => {
      if (event.button !== 0) return;
      const place = at(event);
      element.setPointerCapture(event.pointerId);
      fingers.down(event.pointerId, ...place);
      const index = fingers.count === 1 ? nearest(place, limitOf(event)) : null;
      held.value = index;
      pressedAt = fingers.count === 1 && index === null ? place : null;
      const placed = state.shownPlane.value;
      if (index === null || !placed) return;
      const [x, y] = handles.value[index];
      grip = [x - place[0], y - place[1]];
      last = placed.points[index];
    };
    const move = (event: PointerEvent) => {
      const place = at(event);
      if (fingers.count === 0) {
        const overHandle = nearest(place, limitOf(event)) !== null;
        element.classList.toggle("over-handle", overHandle);
        element.classList.toggle("over-edge", !overHandle && edgeAt(place, event) !== null);
        return;
      }
      const moved = fingers.move(event.pointerId, ...place);
      if (!moved) return;
      if (held.value !== null) {
        const wanted: [number, number] = [place[0] + grip[0], place[1] + grip[1]];
        const point = surfaceUnder(projection.value, wanted, state.far.value, last);
        if (movePoint(state, held.value, point)) last = point;
        return;
      }
      const turned = orbited(
        state.camera.value,
        moved.right * degreesPerPixel,
        moved.down * degreesPerPixel,
      );
      state.camera.value = zoomed(turned, moved.factor);
    };
    const up = (event: PointerEvent) => {
      fingers.up(event.pointerId);
      held.value = null;
      const place = at(event);
      const clicked =
        pressedAt !== null &&
        event.type === "pointerup" &&
        Math.hypot(place[0] - pressedAt[0], place[1] - pressedAt[1]) < leastDrag;
      pressedAt = null;
      const edge = clicked ? edgeAt(place, event) : null;
      if (edge !== null) chooseEdge(state, edge);
    };
    const wheel = (event: WheelEvent) => {
      event.preventDefault();
      state.camera.value = zoomed(state.camera.value, Math.exp(-event.deltaY / 600));
    };
    element.addEventListener("pointerdown", down);
    element.addEventListener("pointermove", move);
    element.addEventListener("pointerup", up);
    element.addEventListener("pointercancel", up);
    element.addEventListener("wheel", wheel, { passive: false });
    return () => {
      element.removeEventListener("pointerdown", down);
      element.removeEventListener("pointermove", move);
      element.removeEventListener("pointerup", up);
      element.removeEventListener("pointercancel", up);
      element.removeEventListener("wheel", wheel);
    };
  }, []);
}
