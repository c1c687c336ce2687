import { computed, effect, signal, type Signal } from "@preact/signals";

import { getJson, sentenceOf } from "../api/client";
import { onAttempt, onGap, sampleProgress, service, status } from "../api/live";
import { retryWaitMs } from "../api/retry_wait";
import type { History, Sample } from "../api/types";
import { highestMarked, marksWith, noMarks, type JudgedAttempt } from "./layer_marks";
import { filteredLayers, type LayerFilter } from "./layer_sequence";

/** What the Layers view knows of the sample as a whole. It stays when another view is looked at. */

export const sample = signal<Sample | null>(null);
/** What the server said when it could not tell of the sample; empty when it could. */
export const sampleTrouble = signal("");
/** Likewise of the attempts. */
export const historyTrouble = signal("");
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

/** False until the first frame was judged, or a layer came from elsewhere: nothing to ask for yet. */
export const begun = computed(
  () => committed.value > 0 || marks.value.ids.size > 0 || Boolean(status.value?.last_attempt),
);

/** The last attempt of the history that was fetched. */
let historyEnd = 0;

const retryMs = 3000;

/** Keeps all this up to date; gives what ends it. */
export function watchLayers(): () => void {
  const askHistory = asking(learnHistory, historyTrouble);
  const askSample = asking(learnSample, sampleTrouble);
  const stops = [
    onAttempt((attempt) => {
      marks.value = marksWith(marks.value, [attempt]);
    }),
    onGap(askHistory.now),
    effect(() => {
      if (begun.value) askHistory.now();
    }),
    effect(() => {
      void sampleProgress.value; // what was not there may be there now
      if (begun.value && sample.value === null) askSample.now();
    }),
    askHistory.end,
    askSample.end,
  ];
  return () => {
    for (const stop of stops) stop();
  };
}

interface Asking {
  now(): void;
  end(): void;
}

/** Asks one thing at a time, once more if that was wished meanwhile, and again where it may help. */
function asking(ask: (signal: AbortSignal) => Promise<void>, trouble: Signal<string>): Asking {
  const ended = new AbortController();
  let underWay = false;
  let wished = false; // while it was under way: what is on its way may be older than the wish
  let retry: ReturnType<typeof setTimeout> | undefined;
  const now = () => {
    wished = underWay;
    if (underWay) return;
    clearTimeout(retry);
    underWay = true;
    ask(ended.signal)
      .then(() => {
        trouble.value = "";
      })
      .catch((error: unknown) => {
        if (ended.signal.aborted) return;
        const wait = retryWaitMs(error, retryMs);
        if (wait === null) trouble.value = sentenceOf(error);
        else retry = setTimeout(now, wait);
      })
      .finally(() => {
        underWay = false;
        if (wished && !ended.signal.aborted) now();
      });
  };
  const end = () => {
    ended.abort();
    clearTimeout(retry);
  };
  return { now, end };
}

async function learnSample(signal: AbortSignal): Promise<void> {
  sample.value = await getJson<Sample>("/api/v1/sample", signal);
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
