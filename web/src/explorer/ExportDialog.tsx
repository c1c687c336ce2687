import { type Signal, useSignalEffect } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { Button } from "../ui/Button";
import { Dialog } from "../ui/Dialog";
import { ExportList } from "./ExportList";
import type { ExplorerState } from "./explorer_state";
import type { ExportFormat, ExportJobs } from "./export_jobs";
import { type ExportChoice, orderOf } from "./export_order";
import { leastSpacing } from "./geometry/cuboid";
import { NumberField } from "./NumberField";
import { onBack } from "./on_back";
import { refusalWords } from "./refusal_words";
import type { SeriesPlayer } from "./series_player";
import { SeriesFields } from "./SeriesFields";
import { useExportSize } from "./use_export_size";

interface Props {
  state: ExplorerState;
  player: SeriesPlayer;
  exports: ExportJobs;
  choice: Signal<ExportChoice>;
  onClose: () => void;
}

const formats: { format: ExportFormat; label: string }[] = [
  { format: "png", label: "PNG" },
  { format: "tiff", label: "TIFF" },
  { format: "jpeg", label: "JPEG" },
];

/** Has pictures written by the server, as files to be downloaded. */
export function ExportDialog({ state, player, exports, choice, onClose }: Props) {
  const change = (changed: Partial<ExportChoice>) =>
    (choice.value = { ...choice.value, ...changed });
  const { kind, format, pixel, movie, frames, rate } = choice.value;
  const cuboid = state.cuboid.value;
  const size = useExportSize(state, player, choice);
  useEffect(() => {
    void exports.learn();
    return onBack(() => void exports.learn());
  }, []);
  useSignalEffect(() => {
    if (exports.news.value) exports.news.value = null; // it is seen
  });
  const order = orderOf(state, player.choice.value, choice.value);

  return (
    <Dialog title="Export" onClose={onClose} wide>
      <form
        class="export-form"
        onSubmit={(event) => {
          event.preventDefault();
          if (order) void exports.order(order);
        }}
      >
        <fieldset class="choice-row">
          <legend>What</legend>
          <Radio
            name="kind"
            checked={kind === "section"}
            onChoose={() => change({ kind: "section" })}
          >
            Section
          </Radio>
          <Radio
            name="kind"
            checked={kind === "series"}
            onChoose={() => change({ kind: "series" })}
          >
            Series
          </Radio>
        </fieldset>
        {kind === "series" && <SeriesFields state={state} player={player} />}
        <fieldset class="choice-row">
          <legend>Pictures as</legend>
          {formats.map(({ format: each, label }) => (
            <Radio
              key={each}
              name="format"
              checked={format === each}
              onChoose={() => change({ format: each })}
            >
              {label}
            </Radio>
          ))}
        </fieldset>
        {kind === "series" && (
          <fieldset class="choice-row">
            <legend>Files</legend>
            <label class="choice">
              <input
                type="checkbox"
                checked={frames}
                onChange={(event) => change({ frames: event.currentTarget.checked })}
              />
              Pictures, in one .zip
            </label>
            <label class="choice">
              <input
                type="checkbox"
                checked={movie}
                onChange={(event) => change({ movie: event.currentTarget.checked })}
              />
              Film, .mp4
            </label>
            {movie && (
              <NumberField
                label="Rate"
                value={rate}
                min={1}
                max={120}
                unit="per s"
                onChange={(typed) => (typed > 0 ? void change({ rate: typed }) : false)}
              />
            )}
          </fieldset>
        )}
        <NumberField
          label="Pixel"
          value={pixel ?? (cuboid ? leastSpacing(cuboid) : 1)}
          unit="µm"
          onChange={(typed) => (typed > 0 ? void change({ pixel: typed }) : false)}
        />
        <p class="muted" aria-live="polite">
          {size}
        </p>
        {exports.failure.value && (
          <p class="notice notice-bad" role="alert">
            {refusalWords(exports.failure.value)}
          </p>
        )}
        <div class="button-row">
          <Button submit kind="primary" disabled={!order || exports.ordering.value}>
            Export
          </Button>
        </div>
      </form>
      <ExportList exports={exports} />
    </Dialog>
  );
}

interface RadioProps {
  name: string;
  checked: boolean;
  onChoose: () => void;
  children: string;
}

function Radio({ name, checked, onChoose, children }: RadioProps) {
  return (
    <label class="choice">
      <input type="radio" name={name} checked={checked} onChange={onChoose} />
      {children}
    </label>
  );
}
