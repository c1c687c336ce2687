import type uPlot from "uplot";

import type { Bound } from "../journal/metric_words";
import { layerHash } from "../layers/layer_link";
import { goTo } from "../shell/route";
import { fixed } from "../ui/numbers";
import { firstRowFrom, limitLines } from "./chart_data";
import { history } from "./run_history";

export const chartHeight_px = 150;
const hit_px = 14; // so near to a rejected attempt a click means it

interface ChartLook {
  /** Where it is drawn: its colours and its font are this element's. */
  element: HTMLElement;
  bound: Bound;
  tick: (value: number, step: number) => string;
  /** There are so many rejected attempts that they are drawn small. */
  many: boolean;
  /** The row under the cursor, or that there is none. */
  show: (row: number | null) => void;
  setZoomed: (zoomed: boolean) => void;
}

/** How uPlot draws what chartData() gives. */
export function chartOptions({
  element,
  bound,
  tick,
  many,
  show,
  setZoomed,
}: ChartLook): uPlot.Options {
  const style = getComputedStyle(element);
  const colour = (variable: string) => style.getPropertyValue(variable).trim();
  const font = `12px ${style.fontFamily}`;
  const axis = {
    stroke: colour("--muted"),
    font,
    grid: { stroke: colour("--line"), width: 1 },
    ticks: { show: false },
  };
  const limitLine: uPlot.Series = {
    stroke: colour("--bad"),
    width: 1.5,
    dash: [6, 4],
    points: { show: false },
    spanGaps: true,
  };
  return {
    width: element.clientWidth,
    height: chartHeight_px,
    legend: { show: false },
    cursor: {
      sync: { key: "run" },
      points: { size: 7 },
    },
    scales: { x: { time: false }, y: { range: padded } },
    axes: [
      {
        ...axis,
        size: 28,
        incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000],
        values: (_made, ticks) => ticks.map((layer) => fixed(layer)),
      },
      {
        ...axis,
        size: 56,
        space: 24, // px at least between lines
        // An axis without anything on it says nothing.
        values: (made, ticks, _axis, _space, step) =>
          made.data[0].length === 0 ? [] : ticks.map((value) => tick(value, step)),
      },
    ],
    series: [
      {},
      { stroke: colour("--accent"), width: 2, spanGaps: true, points: { show: lonely } },
      {
        stroke: colour("--bad"),
        width: 0,
        paths: () => null,
        points: {
          show: true,
          size: many ? 5 : 9,
          fill: colour("--bad-ground"),
          width: many ? 1 : 2,
        },
      },
      ...Array.from({ length: limitLines(bound) }, () => limitLine),
    ],
    hooks: {
      setCursor: [
        (made) => {
          made.over.classList.toggle("chart-hit", rejectedUnder(made) !== null);
          show(
            made.cursor.left !== undefined && made.cursor.left >= 0
              ? (made.cursor.idx ?? null)
              : null,
          );
        },
      ],
      setSelect: [
        (made) => {
          if (made.select.width > 0) setZoomed(true);
        },
      ],
      ready: [
        (made) => {
          made.over.addEventListener("click", () => {
            const row = rejectedUnder(made);
            if (row === null) return;
            goTo(layerHash({ layer: history.layer[row], attempt: history.attempt[row] }));
          });
          // uPlot shows the whole again.
          made.over.addEventListener("dblclick", () => setZoomed(false));
        },
      ],
    },
  };
}

/** Points are drawn where there are so few that a line says little. */
const lonely = (made: uPlot): boolean => made.data[0].length < 40;

/** Everything drawn fits in, with a little air; a flat line stands in the middle. */
function padded(_made: uPlot, least: number | null, most: number | null): [number, number] {
  if (least === null || most === null) return [0, 1];
  const span = most - least || Math.abs(most) * 0.1 || 1;
  return [least - span * 0.1, most + span * 0.1];
}

/** The row of the rejected attempt at the pointer; null when there is none near it. */
function rejectedUnder(made: uPlot): number | null {
  const { left = -1, top = -1 } = made.cursor;
  if (left < 0) return null;
  const layers = made.data[0];
  const rejected = made.data[2];
  const first = made.posToVal(left - hit_px, "x");
  const last = made.posToVal(left + hit_px, "x");
  let nearest = { row: -1, distance: hit_px };
  for (
    let row = firstRowFrom(layers, first);
    row < layers.length && layers[row] <= last;
    row += 1
  ) {
    const value = rejected[row];
    if (value === null || value === undefined) continue;
    const x = made.valToPos(layers[row], "x") - left;
    const distance = Math.hypot(x, made.valToPos(value, "y") - top);
    if (distance < nearest.distance) nearest = { row, distance };
  }
  return nearest.row < 0 ? null : nearest.row;
}
