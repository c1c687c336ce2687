import { effect, useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { fixed } from "../ui/numbers";
import { arrows, moveByArrow } from "./arrow_keys";
import { bestRenderer } from "./best_renderer";
import { surfacePoint } from "./box_surface";
import { axisLabels } from "./cuboid_scene";
import type { CuboidRenderer, SceneColours } from "./cuboid_scene";
import type { ExplorerState } from "./explorer_state";
import { Fingers } from "./fingers";
import { depthOfLayer } from "./geometry/cuboid";
import { cornersOf } from "./geometry/plane_rectangle";
import { scale } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import {
  orbited,
  projected,
  projectionOf,
  startingCamera,
  unprojected,
  zoomed,
} from "./orbit_camera";
import { useSize } from "./use_size";

const degreesPerPixel = 0.5;
const reach = { mouse: 16, touch: 28 }; // how near to a point a press takes hold of it, CSS pixels

const labelRoom = 38; // beside the middle of a label, CSS pixels

const help =
  "The block in 3D. Arrow up and down move the plane by a step, page up and page down by ten, " +
  "arrow left and right tilt it. With Shift, arrow keys turn the view; plus and minus zoom, 0 " +
  "starts anew. Keys 1, 2 and 3 choose a point of the plane, which the arrow keys then move; " +
  "Escape lets it go.";

interface Props {
  state: ExplorerState;
}

/** The block with the plane in it. It is drawn anew only when something changed. */
export function CuboidView({ state }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const renderer = useSignal<CuboidRenderer | null>(null);
  const failure = useSignal("");
  const held = useSignal<number | null>(null); // the point that is being moved
  const size = useSize(box);

  const projection = useComputed(() =>
    projectionOf(state.camera.value, state.far.value, size.value.width, size.value.height),
  );
  const handles = useComputed(() =>
    (state.shownPlane.value?.points ?? []).map((point) => projected(projection.value, point)),
  );

  useEffect(() => {
    let wanted = true;
    bestRenderer(canvas.current!).then(
      (made) => (wanted ? (renderer.value = made) : made.dispose()),
      () => (failure.value = "The block can't be drawn in this browser."),
    );
    return () => {
      wanted = false;
      renderer.value?.dispose();
    };
  }, []);

  const dark = useSignal(0);
  useEffect(() => {
    const scheme = window.matchMedia("(prefers-color-scheme: dark)");
    const changed = () => (dark.value += 1);
    scheme.addEventListener("change", changed);
    return () => scheme.removeEventListener("change", changed);
  }, []);

  useEffect(() => drawOnDemand(() => canvas.current, state, renderer, projection, size, dark), []);
  useCuboidPointer(canvas, state, projection, handles, held);

  return (
    <div class="cuboid" ref={box}>
      <canvas
        ref={canvas}
        class="cuboid-canvas"
        data-role="cuboid"
        data-handles={JSON.stringify(
          handles.value.map((at) => at.map((v) => Math.round(v * 10) / 10)),
        )}
        tabIndex={0}
        role="application"
        aria-label={help}
        onKeyDown={(event) => pressed(event, state, projection.value, held)}
        onBlur={() => (held.value = null)}
      />
      {size.value.width > 0 && (
        <Overlay state={state} projection={projection} handles={handles} held={held} />
      )}
      {failure.value && <p class="notice notice-warn">{failure.value}</p>}
    </div>
  );
}

type Signal<T> = { readonly value: T };
type Writable<T> = { value: T };
type View = ReturnType<typeof projectionOf>;

/** Draws in the next frame of the screen whenever what is drawn has changed. */
function drawOnDemand(
  canvasOf: () => HTMLCanvasElement | null,
  state: ExplorerState,
  renderer: Signal<CuboidRenderer | null>,
  projection: Signal<View>,
  size: Signal<{ width: number; height: number; ratio: number }>,
  scheme: Signal<number>,
): () => void {
  let frame = 0;
  const draw = () => {
    frame = 0;
    const canvas = canvasOf();
    const { width, height, ratio } = size.value;
    const cuboid = state.cuboid.value;
    if (!canvas || !renderer.value || !cuboid || width === 0 || height === 0) return;
    const [columns, rows] = [Math.floor(width * ratio), Math.floor(height * ratio)];
    if (canvas.width !== columns || canvas.height !== rows) {
      canvas.width = columns;
      canvas.height = rows;
    }
    const layers = state.layersPresent.value;
    renderer.value.draw(
      {
        projection: projection.value,
        far: state.far.value,
        depthPresent: depthOfLayer(cuboid, Math.max(1, layers)),
        picture: state.shownPicture.value,
        polygon: state.shownPlane.value?.polygon ?? [],
        colours: coloursOf(canvas),
      },
      ratio,
    );
  };
  const stop = effect(() => {
    void [renderer.value, projection.value, size.value, scheme.value];
    void [state.shownPlane.value, state.shownPicture.value];
    void [state.cuboid.value, state.layersPresent.value];
    if (frame === 0) frame = requestAnimationFrame(draw);
  });
  return () => {
    stop();
    cancelAnimationFrame(frame);
  };
}

function coloursOf(element: Element): SceneColours {
  const style = getComputedStyle(element);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  return {
    line: colour("--line-strong"),
    missing: colour("--muted"),
    plane: colour("--accent"),
  };
}

interface OverlayProps extends Props {
  projection: Signal<View>;
  handles: Signal<[number, number][]>;
  held: Signal<number | null>;
}

/** Lines and words over the picture, sharp at any size. */
function Overlay({ state, projection, handles, held }: OverlayProps) {
  const view = projection.value;
  const far = state.far.value;
  const cuboid = state.cuboid.value;
  const placed = state.shownPlane.value;
  if (!cuboid) return null;
  const path = (points: readonly Vector3[]) =>
    points
      .map((point) =>
        projected(view, point)
          .map((v) => v.toFixed(1))
          .join(","),
      )
      .join(" ");
  const rectangle = state.frame.value ? null : state.rectangle.value;
  const layers = state.layersPresent.value;
  const depth = depthOfLayer(cuboid, Math.max(1, layers));
  const grounds = layers < cuboid.size[2];
  return (
    <svg class="cuboid-overlay" width={view.width} height={view.height} aria-hidden="true">
      {grounds && (
        <polygon
          class="newest-face"
          points={path([
            [0, 0, depth],
            [far[0], 0, depth],
            [far[0], far[1], depth],
            [0, far[1], depth],
          ])}
        />
      )}
      {axisLabels(far, (point) => projected(view, point)).map(({ axis, x, y }) => (
        <text
          key={axis}
          x={Math.min(view.width - labelRoom, Math.max(labelRoom, x))}
          y={y}
          class="axis-label"
        >
          {"xyz"[axis]} {fixed(far[axis] / 1000, 2)} mm
        </text>
      ))}
      {placed && <polygon class="section-outline" points={path(placed.polygon)} />}
      {rectangle && state.choices.value.theta.kind !== "bounding" && (
        <polygon class="theta-outline" points={path(cornersOf(rectangle))} />
      )}
      {handles.value.map(([x, y], i) => (
        <g key={i} class={held.value === i ? "handle handle-held" : "handle"}>
          <circle cx={x} cy={y} r={9} />
          <text x={x} y={y}>
            {i + 1}
          </text>
        </g>
      ))}
    </svg>
  );
}

/** The point under a place of the screen, on the surface of the block. */
function pointAt(
  view: View,
  at: readonly [number, number],
  far: Vector3,
  before: Vector3,
): Vector3 {
  return surfacePoint(unprojected(view, at), scale(-1, view.axes.towards), far, before);
}

function useCuboidPointer(
  canvas: { current: HTMLCanvasElement | null },
  state: ExplorerState,
  projection: Signal<View>,
  handles: Signal<[number, number][]>,
  held: Writable<number | null>,
): void {
  useEffect(() => {
    const element = canvas.current!;
    const fingers = new Fingers();
    let grip: [number, number] = [0, 0]; // from the pointer to the point it holds
    let last: Vector3 = [0, 0, 0];

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

    const down = (event: PointerEvent) => {
      if (event.button !== 0) return;
      const place = at(event);
      element.setPointerCapture(event.pointerId);
      fingers.down(event.pointerId, ...place);
      const index = fingers.count === 1 ? nearest(place, limitOf(event)) : null;
      held.value = index;
      const placed = state.shownPlane.value;
      if (index === null || !placed) return;
      const [x, y] = handles.value[index];
      grip = [x - place[0], y - place[1]];
      last = placed.points[index];
    };
    const move = (event: PointerEvent) => {
      const place = at(event);
      if (fingers.count === 0) {
        element.classList.toggle("over-handle", nearest(place, limitOf(event)) !== null);
        return;
      }
      const moved = fingers.move(event.pointerId, ...place);
      if (!moved) return;
      if (held.value !== null) {
        const wanted: [number, number] = [place[0] + grip[0], place[1] + grip[1]];
        const point = pointAt(projection.value, wanted, state.far.value, last);
        if (state.movePoint(held.value, point)) last = point;
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

function pressed(
  event: KeyboardEvent,
  state: ExplorerState,
  view: View,
  held: Writable<number | null>,
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
  else if (event.key === "PageDown") state.nudge(10);
  else if (event.key === "PageUp") state.nudge(-10);
  else return;
  event.preventDefault();
}

function movePointBy(
  state: ExplorerState,
  view: View,
  index: number,
  [right, down]: [number, number],
  pixels: number,
): void {
  const point = state.shownPlane.value?.points[index];
  if (!point) return;
  const [x, y] = projected(view, point);
  const wanted: [number, number] = [x + right * pixels, y + down * pixels];
  state.movePoint(index, pointAt(view, wanted, state.far.value, point));
}
