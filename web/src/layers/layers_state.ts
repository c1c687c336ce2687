import { computed, effect, signal } from "@preact/signals";

import { ConnectionError, getJson, sentenceOf } from "../api/client";
import { onAttempt, onGap, sampleProgress, service } from "../api/live";
import type { History, Sample } from "../api/types";
import { highestMarked, marksWith, noMarks, type JudgedAttempt } from "./layer_marks";
import { filteredLayers, type LayerFilter } from "./layer_sequence";

/** What the Layers view knows of the sample as a whole. It stays when another view is looked at. */

export const sample = signal<Sample | null>(null);
/** Why there is no sample to show; empty while there may be one. */
export const sampleTrouble = signal("");
export const marks = signal(noMarks);
/** False where the sample was imported, so that nothing was ever judged. */
export const judged = computed(() => marks.value.ids.size > 0 || service.value?.kind === "rig");
export const filter = signal<LayerFilter>("all");

/** Layers 1 to this one have an image. */
export const committed = computed(() =>
  Math.max(
    sampleProgress.value?.committed ?? 0,
    sample.value?.committed ?? 0,
    sample.value?.layers_present ?? 0,
  ),
);

/** The last layer of which anything is known: it may be in work still, and have no image. */
export const highest = computed(() => Math.max(committed.value, highestMarked(marks.value)));

export const sequence = computed(() => filteredLayers(filter.value, marks.value, highest.value));

/** The last attempt of the history that was fetched. */
let historyEnd = 0;

const retryMs = 3000;

/** Keeps all this up to date; gives what ends it. */
export function watchLayers(): () => void {
  let ended = new AbortController();
  let retry: ReturnType<typeof setTimeout> | undefined;

  const learn = () => {
    ended.abort();
    ended = new AbortController();
    clearTimeout(retry);
    Promise.all([learnSample(ended.signal), learnHistory(ended.signal)]).catch((error) => {
      if (ended.signal.aborted) return;
      if (error instanceof ConnectionError) retry = setTimeout(learn, retryMs);
      else sampleTrouble.value = sentenceOf(error);
    });
  };

  learn();
  let name = service.peek()?.sample;
  const stops = [
    onAttempt((attempt) => {
      marks.value = marksWith(marks.value, [attempt]);
    }),
    onGap(learn),
    effect(() => {
      const now = service.value?.sample;
      if (name !== undefined && now !== undefined && now !== name) {
        forget();
        learn();
      }
      name = now ?? name;
    }),
    // A sample that was not there when it was asked for is there as soon as it grows.
    effect(() => {
      if (sampleProgress.value && sampleTrouble.peek()) learn();
    }),
  ];
  return () => {
    ended.abort();
    clearTimeout(retry);
    for (const stop of stops) stop();
  };
}

function forget(): void {
  sample.value = null;
  marks.value = noMarks;
  historyEnd = 0;
}

async function learnSample(signal: AbortSignal): Promise<void> {
  sample.value = await getJson<Sample>("/api/v1/sample", signal);
  sampleTrouble.value = "";
}

async function learnHistory(signal: AbortSignal): Promise<void> {
  const history = await getJson<History>(`/api/v1/history?after=${historyEnd}`, signal);
  historyEnd = history.last;
  marks.value = marksWith(marks.value, attemptsOf(history));
}

function attemptsOf(history: History): JudgedAttempt[] {
  return history.id.map((id, index) => ({
    id,
    layer: history.layer[index],
    verdict: history.verdict[index],
  }));
}
