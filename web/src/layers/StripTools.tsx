import { useState } from "preact/hooks";

import { Button } from "../ui/Button";
import { fixed } from "../ui/numbers";
import { Switch } from "../ui/Switch";
import type { LayerFilter } from "./layer_sequence";

interface Props {
  filter: LayerFilter;
  onFilter: (filter: LayerFilter) => void;
  /** A sample without a journal has nothing to filter by. */
  judged: boolean;
  /** Layers in the strip. */
  count: number;
  /** Layers that have an image. */
  committed: number;
  highest: number;
  following: boolean;
  onFollow: (following: boolean) => void;
  onJump: (layer: number) => void;
  onStep: (steps: number) => void;
}

const filters: { value: LayerFilter; label: string }[] = [
  { value: "all", label: "All" },
  { value: "rejected", label: "Rejected" },
  { value: "flagged", label: "Flagged" },
];

/** What stands above the film strip: which layers it shows, and ways to a layer. */
export function StripTools(props: Props) {
  return (
    <div class="strip-tools">
      {props.judged && (
        <fieldset class="segments">
          <legend class="visually-hidden">Layers shown</legend>
          {filters.map(({ value, label }) => (
            <label key={value} class="segment">
              <input
                type="radio"
                name="layer-filter"
                checked={props.filter === value}
                onChange={() => props.onFilter(value)}
              />
              <span>{label}</span>
            </label>
          ))}
        </fieldset>
      )}
      <span class="muted strip-count">{countWords(props)}</span>
      <div class="strip-steps">
        <Button aria-label="Layer before" onClick={() => props.onStep(-1)}>
          ‹
        </Button>
        <Button aria-label="Next layer" onClick={() => props.onStep(1)}>
          ›
        </Button>
      </div>
      <Jump highest={props.highest} onJump={props.onJump} />
      <Switch checked={props.following} onChange={props.onFollow}>
        Follow the newest
      </Switch>
    </div>
  );
}

function countWords({ filter, count, committed }: Props): string {
  const all = `${fixed(committed)} ${committed === 1 ? "layer" : "layers"}`;
  if (filter === "all") return all;
  const kind = filter === "rejected" ? "with rejected attempts" : "accepted with a flag";
  return `${fixed(count)} of ${all} ${kind}`;
}

function Jump({ highest, onJump }: { highest: number; onJump: (layer: number) => void }) {
  const [text, setText] = useState("");
  const submit = (event: Event) => {
    event.preventDefault();
    const layer = Math.round(Number(text));
    if (!Number.isFinite(layer) || layer < 1) return;
    onJump(Math.min(layer, highest));
    setText("");
  };
  return (
    <form class="strip-jump" onSubmit={submit}>
      <label>
        Go to layer{" "}
        <input
          type="number"
          min={1}
          max={highest}
          inputMode="numeric"
          value={text}
          onInput={(event) => setText(event.currentTarget.value)}
        />
      </label>
      <Button submit>Go</Button>
    </form>
  );
}
