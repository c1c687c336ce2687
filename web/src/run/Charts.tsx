import { metricWords } from "../journal/metric_words";
import { decimalsOf, fixed, micrometres, percent } from "../ui/numbers";
import { LayerChart } from "./LayerChart";

const ratio = (value: number | null) => fixed(value, 3);
const change = (value: number | null) => percent(value === null ? null : value * 100, 1);
const place = (value: number | null) => micrometres(value, 1);

const plainTick = (value: number, step: number) => fixed(value, decimalsOf(step));
const changeTick = (value: number, step: number) => percent(value * 100, decimalsOf(step * 100));

export function Charts() {
  return (
    <section class="charts" aria-label="Over layers">
      <LayerChart
        name="sharpness_ratio"
        title="Sharpness"
        about="against the layer’s focus or the last layers; 1 is as sharp"
        bound={metricWords("sharpness_ratio").bound}
        text={ratio}
        tick={plainTick}
      />
      <LayerChart
        name="brightness"
        title="Brightness"
        about="change against the last layers"
        bound={metricWords("brightness").bound}
        text={change}
        tick={changeTick}
      />
      <LayerChart
        name="focus_change"
        title="Focus change"
        about="against what was expected, in µm a layer"
        bound={metricWords("focus_change").bound}
        text={place}
        tick={plainTick}
      />
      <LayerChart
        name="column_um"
        title="Focus position"
        about="of the column, in µm"
        bound="none"
        text={place}
        tick={plainTick}
      />
    </section>
  );
}
