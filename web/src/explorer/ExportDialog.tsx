import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { getJson, isAbort, sentenceOf } from "../api/client";
import { Button } from "../ui/Button";
import { Dialog } from "../ui/Dialog";
import { bytes, fixed } from "../ui/numbers";
import { ExportList } from "./ExportList";
import type { ExplorerState } from "./explorer_state";
import type { ExportFormat, ExportJobs, ExportOrder } from "./export_jobs";
import { leastSpacing } from "./geometry/cuboid";
import { NumberField } from "./NumberField";
import { fetchOutline } from "./section_fetch";
import { choicesQuery, queryText } from "./section_query";
import type { Query } from "./section_query";
import { seriesQuery } from "./series_choice";
import type { SeriesFrame } from "./series_choice";
import type { SeriesPlayer } from "./series_player";
import { SeriesFields } from "./SeriesFields";

interface Props {
  state: ExplorerState;
  player: SeriesPlayer;
  exports: ExportJobs;
  onClose: () => void;
}

interface Choice {
  kind: "section" | "series";
  format: ExportFormat;
  pixel: number | null; // micrometres; none: full resolution
  movie: boolean;
  frames: boolean;
  rate: number;
}

const formats: { format: ExportFormat; label: string }[] = [
  { format: "png", label: "PNG" },
  { format: "tiff", label: "TIFF" },
  { format: "jpeg", label: "JPEG" },
];

const byDefault: Choice = {
  kind: "section",
  format: "png",
  pixel: null,
  movie: true,
  frames: true,
  rate: 25,
};

/** Has pictures written by the server, as files to be downloaded. */
export function ExportDialog({ state, player, exports, onClose }: Props) {
  const choice = useSignal(byDefault);
  const change = (changed: Partial<Choice>) => (choice.value = { ...choice.value, ...changed });
  const { kind, format, pixel, movie, frames, rate } = choice.value;
  const cuboid = state.cuboid.value;
  const size = useSizeWords(state, player, choice);
  useEffect(() => void exports.learn(), []);
  const order = orderOf(state, player, choice.value);
  const nothing = kind === "series" && !movie && !frames;

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
        {exports.failure.value && <p class="notice notice-bad">{exports.failure.value}</p>}
        <div class="button-row">
          <Button submit kind="primary" disabled={!order || nothing}>
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

function orderOf(
  state: ExplorerState,
  player: SeriesPlayer,
  { kind, format, pixel, movie, frames, rate }: Choice,
): ExportOrder | null {
  const placed = state.placed.value;
  const cuboid = state.cuboid.value;
  const section = state.query.value;
  if (!placed || !cuboid || !section) return null;
  const finer: Query = pixel === null ? {} : { pixel: String(pixel) };
  if (kind === "section") {
    return { kind, format, parameters: { ...section, ...finer }, movie: false, frames: true };
  }
  return {
    kind,
    format,
    parameters: { ...choicesQuery(state.choices.value), ...finer },
    series: seriesQuery(player.choice.value, placed, cuboid),
    movie,
    frames,
    rate,
  };
}

const rest_ms = 200;
const bytesOfPixel = 3;

/** How large it will be, before it is made. */
function useSizeWords(
  state: ExplorerState,
  player: SeriesPlayer,
  choice: { readonly value: Choice },
): string {
  const words = useSignal("");
  useSignalEffect(() => {
    const { kind, pixel } = choice.value;
    const abort = new AbortController();
    const query = state.query.value;
    const placed = state.placed.value;
    const cuboid = state.cuboid.value;
    const series = placed && cuboid && seriesQuery(player.choice.value, placed, cuboid);
    const ask = async () => {
      if (!query || !series) return;
      try {
        const outline = await fetchOutline(
          { ...query, ...(pixel === null ? {} : { pixel: String(pixel) }) },
          abort.signal,
        );
        const { width, height } = outline.full;
        const pixels = `${fixed(width)} × ${fixed(height)} pixels`;
        if (kind === "section") {
          words.value = `${pixels}; ${bytes(width * height * bytesOfPixel)} before compression.`;
          return;
        }
        const { frames } = await getJson<{ frames: SeriesFrame[] }>(
          `/api/v1/series/frames?${queryText(series)}`,
          abort.signal,
        );
        words.value = `${fixed(frames.length)} pictures; the section shown now would have ${pixels}.`;
      } catch (error) {
        if (!isAbort(error)) words.value = sentenceOf(error);
      }
    };
    const timer = setTimeout(() => void ask(), rest_ms);
    return () => {
      clearTimeout(timer);
      abort.abort();
    };
  });
  return words.value;
}
