import type { Metric } from "../api/types";
import { dash } from "../ui/numbers";
import { Table } from "../ui/Table";
import { limitText, metricOrder, metricWords, valueText } from "../journal/metric_words";

/** The metrics of one attempt: those beyond their limit first, then sharpness before all else. */
export function MetricTable({ metrics }: { metrics: readonly Metric[] }) {
  if (metrics.length === 0) return <p class="muted">Nothing was measured of this frame.</p>;
  const ordered = [...metrics].sort(
    (a, b) => Number(a.passed) - Number(b.passed) || metricOrder(a.name) - metricOrder(b.name),
  );
  return (
    <Table
      caption="What was measured"
      head={["Measure", "Value", "Limit", "Passed"]}
      numbers={[1]}
      rows={ordered.map((metric) => {
        const words = metricWords(metric.name);
        return [
          <span title={metric.name}>{words.title}</span>,
          <span class={metric.passed ? undefined : "bad"}>{valueText(metric.value, words)}</span>,
          limitText(metric.limit, words),
          words.bound === "none" ? (
            dash
          ) : metric.passed ? (
            <span class="good">yes</span>
          ) : (
            <strong class="bad">no</strong>
          ),
        ];
      })}
    />
  );
}
