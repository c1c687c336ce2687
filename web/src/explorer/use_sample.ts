import { effect, untracked } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { getJson, isAbort, sentenceOf } from "../api/client";
import { connection, onGap, sampleProgress } from "../api/live";
import type { Sample } from "../api/types";
import type { ExplorerState } from "./explorer_state";

/** Keeps what is known of the sample as it is, while it grows. */
export function useSample(state: ExplorerState): void {
  useEffect(() => {
    const abort = new AbortController();
    let asking = false;
    const learn = async () => {
      if (asking) return;
      asking = true;
      try {
        state.learn(await getJson<Sample>("/api/v1/sample", abort.signal));
        state.failure.value = "";
      } catch (error) {
        if (!isAbort(error)) state.failure.value = sentenceOf(error);
      } finally {
        asking = false;
      }
    };
    // At once; again, while there is none yet, when something is heard of it or of the server.
    const stopHearing = effect(() => {
      const progress = sampleProgress.value;
      void connection.value.state;
      untracked(() => {
        if (progress && state.sample.value) state.grow(progress);
        else if (!state.sample.value) void learn();
      });
    });
    const stopGaps = onGap(() => void learn());
    return () => {
      stopHearing();
      stopGaps();
      abort.abort();
    };
  }, []);
}
