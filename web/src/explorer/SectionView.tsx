import { useComputed, useSignal, useSignalEffect } from "@preact/signals";
import type { ReadonlySignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { arrows, moveByArrow } from "./arrow_keys";
import type { ExplorerState } from "./explorer_state";
import { Fingers } from "./fingers";
import { cornersOf, inPlane, turnedBasis } from "./geometry/plane_rectangle";
import { sectionBasis } from "./geometry/section_basis";
import { norm, subtract } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import { sampleAt } from "./section_record";
import type { SectionTools } from "./section_tools";
import {
  barLength,
  lengthWords,
  movedBy,
  pixelAt,
  placementOf,
  sampleAtPixel,
  zoomedAt,
} from "./section_window";
import type { Placement, SectionWindow } from "./section_window";
import { customBetween } from "./theta_frame";
import { useSize } from "./use_size";

const help =
  "The section. Arrow up and down move the plane by a step, page up and page down by ten. Plus and " +
  "minus zoom, 0 shows all of it; in a close-up, arrow keys move what is seen.";
const reach = 20; // CSS pixels, how near to a corner a press takes hold of it
const leastDrag = 4;

interface Props {
  state: ExplorerState;
  tools: SectionTools;
  children?: ComponentChildren;
}

/** The section's picture, pixel for pixel of the screen where it is sharp. */
export function SectionView({ state, tools, children }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const size = useSize(box);

  useSignalEffect(() => {
    const { width, height, ratio } = size.value;
    state.panel.value = {
      width: Math.floor(width * ratio),
      height: Math.floor(height * ratio),
      ratio,
    };
  });

  const placement = useComputed<Placement | null>(() => {
    const window = state.window.value;
    const record = state.shownPicture.value?.record;
    if (!window || !record) return null;
    const { width, height } = record.picture;
    return placementOf(window, record.rectangle.origin_um, record.pixel_um, width, height);
  });

  useSignalEffect(() => {
    const picture = state.shownPicture.value;
    const element = canvas.current;
    if (!element || !picture) return;
    if (element.width !== picture.image.width) element.width = picture.image.width;
    if (element.height !== picture.image.height) element.height = picture.image.height;
    element.getContext("2d")?.drawImage(picture.image, 0, 0);
    element.dataset.command = picture.record.command_here;
  });
  useSignalEffect(() => {
    const element = canvas.current;
    if (!element) return;
    const playing = state.frame.value !== null;
    const sharp = playing ? state.frame.value?.picture.sharp : state.settled.value;
    const failed = state.failure.value !== "";
    element.dataset.state = failed ? "error" : sharp ? "sharp" : "preview";
  });
  useSignalEffect(() => {
    const element = canvas.current;
    const place = placement.value;
    const { ratio } = state.panel.value;
    if (!element || !place) return;
    element.style.width = `${place.width / ratio}px`;
    element.style.height = `${place.height / ratio}px`;
    element.style.transform = `translate(${place.left / ratio}px, ${place.top / ratio}px)`;
    element.classList.toggle("enlarged", place.width > element.width);
  });

  const draft = useSignal<[Vector3, Vector3] | null>(null); // a rectangle that is being drawn
  useSectionPointer(box, state, tools, placement, draft);

  return (
    <div
      class="section-panel"
      ref={box}
      data-tool={tools.tool.value}
      data-closeup={state.closeup.value ? "" : undefined}
    >
      <canvas
        ref={canvas}
        class="section-canvas"
        data-role="section"
        data-state="preview"
        tabIndex={0}
        role="application"
        aria-label={help}
        onKeyDown={(event) => pressed(event, state, tools)}
        hidden={!placement.value}
      />
      <SectionOverlay state={state} tools={tools} draft={draft} />
      {state.failure.value && (
        <p class="section-failure notice notice-warn">{state.failure.value}</p>
      )}
      {children}
    </div>
  );
}

interface OverlayProps {
  state: ExplorerState;
  tools: SectionTools;
  draft: ReadonlySignal<[Vector3, Vector3] | null>;
}

function SectionOverlay({ state, tools, draft }: OverlayProps) {
  const window = state.window.value;
  const { ratio } = state.panel.value;
  const placed = state.shownPlane.value;
  if (!window || !placed || !state.shownPicture.value) return null;
  const at = (point: Vector3): [number, number] => {
    const [x, y] = pixelAt(window, inPlane(window.frame, point));
    return [x / ratio, y / ratio];
  };
  const path = (points: readonly Vector3[]) =>
    points
      .map((point) =>
        at(point)
          .map((v) => v.toFixed(1))
          .join(","),
      )
      .join(" ");
  const playing = state.frame.value !== null;
  const picture = state.shownPicture.value;
  const polygon = playing || picture.whole ? picture.record.polygon_um : placed.polygon;
  const rectangle = playing ? null : state.rectangle.value;
  const { theta } = state.choices.value;
  const measured = tools.measured.value;
  return (
    <svg
      class="section-overlay"
      width={window.width / ratio}
      height={window.height / ratio}
      aria-hidden="true"
    >
      <polygon class="section-outline" points={path(polygon)} />
      {rectangle && theta.kind !== "bounding" && state.around.value && (
        <>
          <polygon class="theta-outline" points={path(cornersOf(rectangle))} />
          {theta.kind === "custom" &&
            cornersOf(rectangle).map((corner, i) => {
              const [x, y] = at(corner);
              return <circle key={i} class="theta-corner" cx={x} cy={y} r={7} />;
            })}
        </>
      )}
      {theta.kind === "edge" && (
        <EdgeNumbers
          polygon={polygon}
          at={at}
          chosen={theta.edge}
          room={[window.width / ratio, window.height / ratio]}
        />
      )}
      {draft.value && <DraftRectangle ends={draft.value.map(at) as [Place, Place]} />}
      {measured && <Distance from={measured.from} to={measured.to} at={at} />}
      <ScaleBar window={window} ratio={ratio} />
    </svg>
  );
}

type Place = [number, number];
type At = (point: Vector3) => Place;

function EdgeNumbers({
  polygon,
  at,
  chosen,
  room,
}: {
  polygon: readonly Vector3[];
  at: At;
  chosen: number;
  room: Place;
}) {
  const inside = (value: number, length: number) => Math.min(length - 14, Math.max(14, value));
  return (
    <>
      {polygon.map((vertex, i) => {
        const [ax, ay] = at(vertex);
        const [bx, by] = at(polygon[(i + 1) % polygon.length]);
        return (
          <g key={i} class={i === chosen ? "edge edge-chosen" : "edge"}>
            <line x1={ax} y1={ay} x2={bx} y2={by} />
            <text
              x={inside((ax + bx) / 2, room[0])}
              y={inside((ay + by) / 2, room[1])}
              class="over-picture"
            >
              {i}
            </text>
          </g>
        );
      })}
    </>
  );
}

function DraftRectangle({ ends: [[ax, ay], [bx, by]] }: { ends: [Place, Place] }) {
  return (
    <rect
      class="theta-outline"
      x={Math.min(ax, bx)}
      y={Math.min(ay, by)}
      width={Math.abs(bx - ax)}
      height={Math.abs(by - ay)}
    />
  );
}

function Distance({ from, to, at }: { from: Vector3; to: Vector3 | null; at: At }) {
  const [x1, y1] = at(from);
  if (!to) return <circle class="measure-end" cx={x1} cy={y1} r={4} />;
  const [x2, y2] = at(to);
  return (
    <g>
      <line class="measure-casing" x1={x1} y1={y1} x2={x2} y2={y2} />
      <line class="measure-line" x1={x1} y1={y1} x2={x2} y2={y2} />
      <circle class="measure-end" cx={x1} cy={y1} r={4} />
      <circle class="measure-end" cx={x2} cy={y2} r={4} />
      <text class="over-picture" x={(x1 + x2) / 2} y={(y1 + y2) / 2 - 8}>
        {lengthWords(norm(subtract(to, from)))}
      </text>
    </g>
  );
}

function ScaleBar({ window, ratio }: { window: SectionWindow; ratio: number }) {
  const um = barLength((window.pixel * window.width) / 4);
  const width = um / window.pixel / ratio;
  const bottom = window.height / ratio - 14;
  return (
    <g class="scale-bar">
      <rect x={14} y={bottom - 5} width={width} height={5} />
      <text class="over-picture" x={14 + width / 2} y={bottom - 11}>
        {lengthWords(um)}
      </text>
    </g>
  );
}

/** What of the sample is at a place of the panel, in CSS pixels; none beside the picture. */
function sampleUnder(
  state: ExplorerState,
  placement: Placement | null,
  [x, y]: Place,
): Vector3 | null {
  const picture = state.shownPicture.value;
  if (!picture || !placement) return null;
  const { ratio } = state.panel.value;
  const { width, height } = picture.record.picture;
  const u = ((x * ratio - placement.left) / placement.width) * width - 0.5;
  const v = ((y * ratio - placement.top) / placement.height) * height - 0.5;
  const beside = u < -0.5 || v < -0.5 || u > width - 0.5 || v > height - 0.5;
  return beside ? null : sampleAt(picture.record, u, v);
}

function useSectionPointer(
  box: { current: HTMLDivElement | null },
  state: ExplorerState,
  tools: SectionTools,
  placement: ReadonlySignal<Placement | null>,
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
        const [cx, cy] = pixelAt(window, inPlane(window.frame, corner));
        return Math.hypot(cx / state.panel.value.ratio - x, cy / state.panel.value.ratio - y);
      });
      const least = Math.min(...distances);
      return least > reach ? null : corners[(distances.indexOf(least) + 2) % 4];
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
      tools.cursor.value = sampleUnder(state, placement.value, place);
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
        if (!clicked) {
          state.around.value = true;
          const placed = state.placed.value;
          const custom =
            placed &&
            customBetween(sectionBasis(state.choices.value.basis, placed.plane), 0, ...ends);
          if (custom) state.choose({ theta: custom });
          tools.take("look");
        }
      } else if (clicked && tools.tool.value === "measure" && event.type === "pointerup") {
        const point = sampleUnder(state, placement.value, place);
        if (point) tools.measure(point);
      }
      opposite = null;
      pressedAt = null;
    };
    const left = () => (tools.cursor.value = null);
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

/** Zooms about a place of the panel, in pixels of the screen; by itself about the middle. */
export function zoomAbout(state: ExplorerState, factor: number, place?: Place): void {
  const window = state.window.value;
  if (!window || state.frame.value) return;
  const middle: Place = place ?? [window.width / 2, window.height / 2];
  state.closeup.value = zoomedAt(window, factor, middle, state.finestPixel.value);
}

function pressed(event: KeyboardEvent, state: ExplorerState, tools: SectionTools): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const arrow = arrows[event.key];
  const window = state.window.value;
  if (arrow && state.closeup.value && window) {
    const step = window.width / 16;
    state.closeup.value = movedBy(window, arrow[0] * step, arrow[1] * step);
  } else if (arrow) moveByArrow(state, arrow);
  else if (event.key === "+" || event.key === "=") zoomAbout(state, 1.5);
  else if (event.key === "-") zoomAbout(state, 1 / 1.5);
  else if (event.key === "0") state.closeup.value = null;
  else if (event.key === "PageDown") state.nudge(10);
  else if (event.key === "PageUp") state.nudge(-10);
  else if (event.key === "Escape" && tools.tool.value !== "look") tools.take("look");
  else return;
  event.preventDefault();
}
