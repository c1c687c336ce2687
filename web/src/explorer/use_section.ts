import { effect } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { isAbort, sentenceOf } from "../api/client";
import { persistently } from "../api/retry_wait";
import type { ExplorerState } from "./explorer_state";
import { onBack } from "./on_back";
import { rectangleOf } from "./section_record";
import { fetchOutline, fetchPicture, busyWait_ms } from "./section_fetch";
import { SectionLoader } from "./section_loader";
import type { Wish } from "./section_loader";
import { isKnownHere } from "./theta_frame";

/** Keeps the pictures coming that the state wishes for. */
export function useSection(state: ExplorerState): void {
  useEffect(() => {
    const loader = new SectionLoader({
      async fetch({ address, sharp, whole }, signal) {
        return { ...(await fetchPicture(address, signal)), sharp, whole };
      },
      deliver: (picture, { of }) => state.show(picture, of),
      fail: (error) => {
        if (!isAbort(error)) state.failure.value = sentenceOf(error);
      },
      busyWait_ms,
    });
    let before: Wish | null = null;
    const stopWishing = effect(() => {
      const wish = state.wish.value;
      if (!wish || wish.sharp.address === before?.sharp.address) return;
      // More layers of the same section: what is seen need not blur meanwhile.
      const grown = before !== null && sameButGrown(before, wish) && state.picture.peek()?.sharp;
      before = wish;
      state.settled.value = false;
      loader.wish(grown ? { ...wish, preview: null } : wish);
    });
    const stopHearing = onBack(() => {
      if (before && !state.settled.peek()) loader.wish(before);
    });
    return () => {
      stopWishing();
      stopHearing();
      loader.stop();
    };
  }, []);

  useEffect(() => watchRectangle(state), []);
}

const withoutGeneration = (address: string): string => address.replace(/&generation=\d+/, "");

const sameButGrown = (before: Wish, after: Wish): boolean =>
  withoutGeneration(before.sharp.address) === withoutGeneration(after.sharp.address);

const outlineRest_ms = 80;
const usualWait_ms = 1000;

/** Asks the server for an inscribed rectangle where no picture tells of it. */
function watchRectangle(state: ExplorerState): () => void {
  let abort: AbortController | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const stop = effect(() => {
    clearTimeout(timer);
    abort?.abort();
    const query = state.query.value;
    const needed = state.around.value && !isKnownHere(state.choices.value.theta);
    if (!query || !needed || state.rectangle.value) return;
    timer = setTimeout(() => {
      abort = new AbortController();
      persistently((signal) => fetchOutline(query, signal), abort.signal, usualWait_ms).then(
        (record) => {
          state.inscribed.value = { of: JSON.stringify(query), rectangle: rectangleOf(record) };
        },
        () => {}, // the picture's own refusal is told
      );
    }, outlineRest_ms);
  });
  return () => {
    stop();
    clearTimeout(timer);
    abort?.abort();
  };
}
