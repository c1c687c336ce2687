import { effect, signal } from "@preact/signals";

import { ApiError, getJson, withQuery } from "../api/client";
import { connection, onAttempt, onGap, sampleProgress, status } from "../api/live";
import type { Attempt, History, Rejected } from "../api/types";
import { isRejected } from "../journal/verdict_words";
import { AttemptHistory } from "./attempt_history";

/** The job's attempts for the Run view: fetched once, then grown by what the stream tells. */

export const chartMetrics = ["sharpness_ratio", "brightness", "focus_change"] as const;
const rejectedShown = 20;
const quickest_ms = 250; // between two looks of the charts at what is new
const refused_ms = 10_000; // until a server that would not answer this is asked again

export const history = new AttemptHistory(chartMetrics);
/** Grows when `history` did. */
export const historyVersion = signal(0);
/** The newest first. */
export const rejectedOfLate = signal<Attempt[]>([]);
export const rejectedCount = signal(0);

/** Attempts that came before the rest was fetched; null when all that is known is in `history`. */
let waiting: Attempt[] | null = [];
let fetching = false;
let wantedAgain = false; // while it was being fetched
let missed = false; // for want of a connection
let due: number | undefined;

function tell(): void {
  due ??= window.setTimeout(() => {
    due = undefined;
    historyVersion.value += 1;
  }, quickest_ms);
}

function take(attempt: Attempt): void {
  if (waiting) {
    waiting.push(attempt);
    fetchOnce();
  } else if (history.append(attempt)) noteRejected(attempt);
}

function noteRejected(attempt: Attempt): void {
  rejectedCount.value = history.rejectedCount;
  if (isRejected(attempt.verdict)) {
    rejectedOfLate.value = [attempt, ...rejectedOfLate.value].slice(0, rejectedShown);
  }
  tell();
}

async function fetchAll(): Promise<void> {
  wantedAgain = fetching;
  if (fetching) return;
  fetching = true;
  waiting ??= [];
  try {
    const metrics = chartMetrics.join(",");
    history.load(
      await getJson<History>(withQuery("/api/v1/history", { metrics, after: history.last })),
    );
    const { rejected } = await getJson<Rejected>(
      withQuery("/api/v1/rejected", { limit: rejectedShown }),
    );
    rejectedOfLate.value = rejected.filter((attempt) => attempt.id <= history.last);
    const came = waiting;
    waiting = null;
    came.forEach(take);
    rejectedCount.value = history.rejectedCount;
    tell();
  } catch (error) {
    // Without a connection it is fetched with the next one.
    const answers = error instanceof ApiError || connection.peek().state === "live";
    if (answers) setTimeout(() => void fetchAll(), refused_ms);
    else missed = true;
  } finally {
    fetching = false;
  }
  if (wantedAgain) void fetchAll();
}

let begun = false;
let fetchedOnce = false;

function fetchOnce(): void {
  if (fetchedOnce) return;
  fetchedOnce = true;
  void fetchAll();
}

/**
 * Begins to collect; from then on it goes on, whatever view is shown. Nothing is asked for before
 * there is something: of a rig that has not begun there is no history yet.
 */
export function collectHistory(): void {
  if (begun) return;
  begun = true;
  onAttempt(take);
  onGap(() => void fetchAll());
  connection.subscribe(({ state }) => {
    if (state !== "live" || !missed) return;
    missed = false;
    void fetchAll();
  });
  effect(() => {
    const committed = sampleProgress.value?.committed || status.value?.committed;
    if (committed) fetchOnce();
  });
}
