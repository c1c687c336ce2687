import type { Sharpness } from "../api/types";
import { significant } from "../ui/numbers";
import { Switch } from "../ui/Switch";
import { cssColour, scaleColour } from "./colour_scale";
import type { Answer } from "./layer_detail";
import { shownRange } from "./sharpness_map";

interface Props {
  shown: boolean;
  onShow: (shown: boolean) => void;
  opacity: number;
  onOpacity: (opacity: number) => void;
  answer: Answer<Sharpness>;
}

/** The switch of the sharpness map, and what its colours mean. */
export function SharpnessTools(props: Props) {
  return (
    <div class="sharpness">
      <Switch checked={props.shown} onChange={props.onShow}>
        Sharpness map
      </Switch>
      {props.shown && (
        <label class="sharpness-opacity">
          Opacity{" "}
          <input
            type="range"
            min={0.1}
            max={1}
            step={0.05}
            value={props.opacity}
            onInput={(event) => props.onOpacity(Number(event.currentTarget.value))}
          />
        </label>
      )}
      {props.shown && <Legend answer={props.answer} />}
    </div>
  );
}

const gradient = `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1]
  .map((part) => cssColour(scaleColour(part)))
  .join(", ")})`;

function Legend({ answer }: { answer: Answer<Sharpness> }) {
  const map = answer.value;
  if (answer.trouble) return <span class="bad">{answer.trouble}</span>;
  if (!map) return <span class="muted">Measuring…</span>;
  const range = shownRange(map);
  if (!range) return <span class="muted">There is too little detail to measure.</span>;
  return (
    <span class="legend" data-role="sharpness" title={map.measure}>
      <span>blurred {significant(range.low)}</span>
      <span class="legend-colours" style={{ background: gradient }} />
      <span>{significant(range.high)} sharp</span>
    </span>
  );
}
