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
    const learn = () =>
      getJson<Sample>("/api/v1/sample", abort.signal).then(
        (sample) => {
          state.failure.value = "";
          state.learn(sample);
        },
        (error) => {
          if (!isAbort(error)) state.failure.value = sentenceOf(error);
        },
      );
    void learn();
    const stopHearing = effect(() => {
      const progress = sampleProgress.value;
      const live = connection.value.state === "live";
      untracked(() => {
        if (progress && state.sample.value) state.grow(progress);
        else if (live || progress) void learn();
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
