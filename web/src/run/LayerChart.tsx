import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import type { Bound } from "../journal/metric_words";
import { goTo, hashOf } from "../shell/route";
import { Button } from "../ui/Button";
import { isDark } from "../ui/dark_scheme";
import { fixed } from "../ui/numbers";
import { chartData, firstRowFrom, lastOf, limitLines } from "./chart_data";
import { history, historyVersion } from "./run_history";

interface Props {
  /** Of a metric, or "column_um". */
  name: string;
  title: string;
  about: string;
  /** How its limit counts. */
  bound: Bound;
  /** How a value is written, with its unit. */
  text: (value: number | null) => string;
  /** How it is written at the axis, where lines are `step` apart. */
  tick: (value: number, step: number) => string;
}

const height_px = 150;
const manyRejected = 60; // from there on they are drawn small
const hit_px = 14; // so near to a rejected attempt a click means it

/** A value over layers, with its limit; rejected attempts stand out and lead to their layer. */
export function LayerChart({ name, title, about, bound, text, tick }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const [zoomed, setZoomed] = useState(false);
  const [row, setRow] = useState<number | null>(null);
  const dark = isDark.value; // its colours are the page's when it is made
  const many = history.rejectedCount > manyRejected;
  const version = historyVersion.value;
  const data = useMemo(() => chartData(history, name, bound), [name, bound, version]);

  useEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const made = new uPlot(
      optionsFor(element, bound, tick, many, setRow, setZoomed),
      data as uPlot.AlignedData,
      element,
    );
    plot.current = made;
    const size = new ResizeObserver(() => {
      made.setSize({ width: element.clientWidth, height: height_px });
    });
    size.observe(element);
    return () => {
      size.disconnect();
      made.destroy();
      plot.current = null;
    };
  }, [name, bound, tick, dark, many]);

  useEffect(() => {
    const made = plot.current;
    if (!made) return;
    // Where somebody has zoomed in, new layers must not zoom out again.
    made.setData(data as uPlot.AlignedData, !zoomed);
    if (zoomed) made.redraw();
  }, [data, zoomed]);

  const { value, limit: limits } = history.column(name);
  const rejected = history.rejectedCount;
  const label =
    value.length === 0
      ? `${title}: nothing yet`
      : `${title} over ${fixed(history.layer[value.length - 1])} layers: ` +
        `last ${text(lastOf(value))}, ${rejected} rejected`;

  return (
    <figure class="chart" data-chart={name} data-count={value.length} data-rejected={rejected}>
      <figcaption class="chart-head">
        <h3>{title}</h3>
        <span class="muted chart-about">{about}</span>
        {zoomed && (
          <Button kind="quiet" class="chart-whole" onClick={() => setZoomed(false)}>
            Show all layers
          </Button>
        )}
        <span class="chart-reading">
          {value.length === 0
            ? "nothing yet"
            : row === null
              ? `last ${text(lastOf(value))}`
              : readingOf(row, value[row], limits[row], text)}
        </span>
      </figcaption>
      <div ref={box} class="chart-box" role="img" aria-label={label} />
    </figure>
  );
}

function readingOf(
  row: number,
  value: number | null,
  limit: number | null,
  text: Props["text"],
): string {
  const words = [`layer ${fixed(history.layer[row])}: ${text(value ?? null)}`];
  if (limit !== null && limit !== undefined) words.push(`limit ${text(limit)}`);
  if (history.rejected[row]) words.push("rejected");
  return words.join(", ");
}

function optionsFor(
  element: HTMLElement,
  bound: Bound,
  tick: Props["tick"],
  many: boolean,
  show: (row: number | null) => void,
  setZoomed: (zoomed: boolean) => void,
): uPlot.Options {
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
    height: height_px,
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
            if (row !== null) goTo(hashOf(["layers", history.layer[row]]));
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
