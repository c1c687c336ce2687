import { percent, significant } from "../ui/numbers";
import { Switch } from "../ui/Switch";
import { cssColour, scaleColour } from "./colour_scale";
import type { MapKind, SharpnessAnswer } from "./sharpness_overlay";

interface Props {
  shown: boolean;
  onShow: (shown: boolean) => void;
  kind: MapKind;
  onKind: (kind: MapKind) => void;
  opacity: number;
  onOpacity: (opacity: number) => void;
  answer: SharpnessAnswer;
}

/** The switch of the sharpness map, and what its colours mean. */
export function SharpnessTools(props: Props) {
  return (
    <div class="sharpness">
      <Switch checked={props.shown} onChange={props.onShow}>
        Sharpness map
      </Switch>
      {props.shown && (
        <>
          <select
            aria-label="What the map shows"
            value={props.kind}
            onChange={(event) => props.onKind(event.currentTarget.value as MapKind)}
          >
            <option value="own">this layer</option>
            <option value="change">against the last</option>
          </select>
          <input
            type="range"
            aria-label="Opacity of the map"
            title="Opacity of the map"
            min={0.1}
            max={1}
            step={0.05}
            value={props.opacity}
            onInput={(event) => props.onOpacity(Number(event.currentTarget.value))}
          />
          <Legend answer={props.answer} />
        </>
      )}
    </div>
  );
}

const gradient = `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1]
  .map((part) => cssColour(scaleColour(part)))
  .join(", ")})`;

function Legend({ answer: { shown, trouble } }: { answer: SharpnessAnswer }) {
  if (trouble) return <span class="bad">{trouble}</span>;
  if (!shown) return <span class="muted">Measuring…</span>;
  const { map, kind, range } = shown;
  if (!range) return <span class="muted">There is too little detail to measure.</span>;
  const words = (value: number) => (kind === "own" ? significant(value) : percent(value * 100));
  return (
    <span class="legend" data-role="sharpness" title={map.measure}>
      <span>soft {words(range.low)}</span>
      <span class="legend-colours" style={{ background: gradient }} />
      <span>{words(range.high)} sharp</span>
    </span>
  );
}
