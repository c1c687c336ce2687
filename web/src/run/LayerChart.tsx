import { signal } from "@preact/signals";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import type { Bound } from "../journal/metric_words";
import { Button } from "../ui/Button";
import { isDark } from "../ui/dark_scheme";
import { fixed } from "../ui/numbers";
import { chartData, lastOf } from "./chart_data";
import { chartHeight_px, chartOptions } from "./chart_options";
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

const manyRejected = 60; // from there on they are drawn small

/** All charts show the same layers: who zooms in one zooms in all. */
const zoomed = signal(false);
const setZoomed = (to: boolean): void => {
  zoomed.value = to;
};

/** A value over layers, with its limit; rejected attempts stand out and lead to their layer. */
export function LayerChart({ name, title, about, bound, text, tick }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const isZoomed = zoomed.value;
  const [row, setRow] = useState<number | null>(null);
  const dark = isDark.value; // its colours are the page's when it is made
  const many = history.rejectedCount > manyRejected;
  const version = historyVersion.value;
  const data = useMemo(() => chartData(history, name, bound), [name, bound, version]);

  useEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const made = new uPlot(
      chartOptions({ element, bound, tick, many, show: setRow, setZoomed }),
      data as uPlot.AlignedData,
      element,
    );
    plot.current = made;
    setZoomed(false); // all are made anew at once
    const size = new ResizeObserver(() => {
      made.setSize({ width: element.clientWidth, height: chartHeight_px });
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
    made.setData(data as uPlot.AlignedData, !isZoomed);
    if (isZoomed) made.redraw();
  }, [data, isZoomed]);

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
        {isZoomed && (
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
