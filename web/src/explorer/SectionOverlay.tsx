import type { ReadonlySignal } from "@preact/signals";

import { lengthWords, roundLength } from "../ui/lengths";
import type { ExplorerState } from "./explorer_state";
import { cornersOf, inPlane } from "./geometry/plane_rectangle";
import { norm, subtract } from "./geometry/vector3";
import type { Vector3 } from "./geometry/vector3";
import { crossOf } from "./measure_cross";
import type { SectionTools } from "./section_tools";
import { pixelAt } from "./section_window";
import type { SectionWindow } from "./section_window";
import { svgPoints } from "./svg_points";

interface OverlayProps {
  state: ExplorerState;
  tools: SectionTools;
  draft: ReadonlySignal<[Vector3, Vector3] | null>;
}

/** Lines, words and the scale bar over the section's picture. */
export function SectionOverlay({ state, tools, draft }: OverlayProps) {
  const window = state.window.value;
  const { ratio } = state.panel.value;
  const placed = state.shownPlane.value;
  if (!window || !placed || !state.shownPicture.value) return null;
  const at = (point: Vector3): [number, number] => {
    const [x, y] = pixelAt(window, inPlane(window.frame, point));
    return [x / ratio, y / ratio];
  };
  const path = (points: readonly Vector3[]) => svgPoints(points, at);
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
      {tools.tool.value === "measure" && <Cross at={crossOf(state, tools)} />}
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

/** Where Enter measures. */
function Cross({ at: [x, y] }: { at: readonly [number, number] }) {
  const path = `M${x - 12} ${y}h24M${x} ${y - 12}v24`;
  return (
    <g>
      <path class="measure-casing" d={path} />
      <path class="measure-line" d={path} />
    </g>
  );
}

function ScaleBar({ window, ratio }: { window: SectionWindow; ratio: number }) {
  const um = roundLength((window.pixel * window.width) / 4);
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
