import { effect, untracked } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { getJson, isAbort, sentenceOf } from "../api/client";
import { connection, onGap, sampleProgress } from "../api/live";
import { retryWaitMs } from "../api/retry_wait";
import type { Sample } from "../api/types";
import type { ExplorerState } from "./explorer_state";

const usualWait_ms = 3000;
const nothingYet = "No layer has been photographed yet.";

/** Keeps what is known of the sample as it is, while it grows. */
export function useSample(state: ExplorerState): void {
  useEffect(() => {
    const abort = new AbortController();
    let asking = false;
    let again: ReturnType<typeof setTimeout> | undefined;
    const learn = async () => {
      if (asking) return;
      asking = true;
      clearTimeout(again);
      try {
        state.learn(await getJson<Sample>("/api/v1/sample", abort.signal));
        state.failure.value = "";
      } catch (error) {
        if (isAbort(error)) return;
        state.failure.value = sentenceOf(error);
        const wait = retryWaitMs(error, usualWait_ms);
        if (wait !== null) again = setTimeout(() => void learn(), wait);
      } finally {
        asking = false;
      }
    };
    // Once there is a layer; again, while it is not known, when something is heard of it or of the
    // server.
    const stopHearing = effect(() => {
      const progress = sampleProgress.value;
      void connection.value.state;
      untracked(() => {
        if (!progress) return;
        if (state.sample.value) state.grow(progress);
        else if (progress.layers_present > 0) void learn();
        else state.failure.value = nothingYet;
      });
    });
    const stopGaps = onGap(() => void learn());
    return () => {
      stopHearing();
      stopGaps();
      clearTimeout(again);
      abort.abort();
    };
  }, []);
}
