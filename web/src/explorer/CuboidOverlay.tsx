import type { ReadonlySignal } from "@preact/signals";

import { fixed } from "../ui/numbers";
import { axisLabels } from "./axis_labels";
import type { ExplorerState } from "./explorer_state";
import { depthOfLayer } from "./geometry/cuboid";
import { cornersOf } from "./geometry/plane_rectangle";
import type { Vector3 } from "./geometry/vector3";
import { projected } from "./orbit_camera";
import type { Projection } from "./orbit_camera";
import { svgPoints } from "./svg_points";

const labelRoom = [46, 10] as const; // beside and above the middle of a label, CSS pixels

const within = (value: number, room: number, length: number): number =>
  Math.min(length - room, Math.max(room, value));

interface Props {
  state: ExplorerState;
  projection: ReadonlySignal<Projection>;
  handles: ReadonlySignal<[number, number][]>;
  held: ReadonlySignal<number | null>;
}

/** Lines and words over the picture, sharp at any size. */
export function CuboidOverlay({ state, projection, handles, held }: Props) {
  const view = projection.value;
  const far = state.far.value;
  const cuboid = state.cuboid.value;
  const placed = state.shownPlane.value;
  if (!cuboid) return null;
  const at = (point: Vector3) => projected(view, point);
  const inView = ([x, y]: readonly [number, number]) =>
    [within(x, labelRoom[0], view.width), within(y, labelRoom[1], view.height)] as const;
  const path = (points: readonly Vector3[]) => svgPoints(points, at);
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
      {axisLabels(far, at, handles.value, inView).map(({ axis, x, y }) => (
        <text key={axis} x={x} y={y} class="axis-label">
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
