import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { getJson, isAbort, sentenceOf } from "../api/client";
import { bytes, fixed } from "../ui/numbers";
import type { ExplorerState } from "./explorer_state";
import { type ExportChoice, pixelQuery } from "./export_order";
import { onBack } from "./on_back";
import { refusalWords } from "./refusal_words";
import { fetchOutline } from "./section_fetch";
import { queryText } from "./section_query";
import { seriesQuery } from "./series_choice";
import type { SeriesFrame } from "./series_choice";
import type { SeriesPlayer } from "./series_player";

const rest_ms = 200;
const bytesOfPixel = 3;

/** How large it will be, before it is made. */
export function useExportSize(
  state: ExplorerState,
  player: SeriesPlayer,
  choice: { readonly value: ExportChoice },
): string {
  const words = useSignal("");
  const returns = useSignal(0); // of the connection: what could not be asked can be now
  useEffect(() => onBack(() => (returns.value += 1)), []);
  useSignalEffect(() => {
    void returns.value;
    const chosen = choice.value;
    const abort = new AbortController();
    const query = state.shownQuery.value;
    const placed = state.placed.value;
    const cuboid = state.cuboid.value;
    const series = placed && cuboid && seriesQuery(player.choice.value, placed, cuboid);
    const ask = async () => {
      if (!query || !series) return;
      try {
        const outline = await fetchOutline({ ...query, ...pixelQuery(chosen) }, abort.signal);
        const { width, height } = outline.full;
        const pixels = `${fixed(width)} × ${fixed(height)} pixels`;
        if (chosen.kind === "section") {
          words.value = `${pixels}; ${bytes(width * height * bytesOfPixel)} before compression.`;
          return;
        }
        const { frames } = await getJson<{ frames: SeriesFrame[] }>(
          `/api/v1/series/frames?${queryText(series)}`,
          abort.signal,
        );
        words.value = `${fixed(frames.length)} pictures; the section shown now would have ${pixels}.`;
      } catch (error) {
        if (!isAbort(error)) words.value = refusalWords(sentenceOf(error));
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
