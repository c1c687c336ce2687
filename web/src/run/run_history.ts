import { signal } from "@preact/signals";

import { ApiError, getJson, isAbort, withQuery } from "../api/client";
import { connection, onAttempt, onGap } from "../api/live";
import type { Attempt, History, Rejected } from "../api/types";
import { AttemptHistory, type RejectedNote } from "./attempt_history";

/** The job's attempts for the Run view: fetched once, then grown by what the stream tells. */

export const chartMetrics = ["sharpness_ratio", "brightness"] as const;
const rejectedShown = 20;
const quickest_ms = 250; // between two looks of the charts at what is new

export const history = new AttemptHistory(chartMetrics);
/** Grows when `history` did. */
export const historyVersion = signal(0);
/** The newest first. */
export const rejectedOfLate = signal<RejectedNote[]>([]);
export const rejectedCount = signal(0);

let waiting: Attempt[] | null = null; // attempts that came while the rest is being fetched
let fetching = false;
let due: number | undefined;

function tell(): void {
  due ??= window.setTimeout(() => {
    due = undefined;
    historyVersion.value += 1;
  }, quickest_ms);
}

function take(attempt: Attempt): void {
  if (waiting) waiting.push(attempt);
  else if (history.append(attempt)) noteRejected(attempt);
}

function noteRejected(attempt: Attempt): void {
  rejectedCount.value = history.rejectedCount;
  const { rejectedOfLate: seen } = history;
  if (seen[0]?.id === attempt.id) {
    rejectedOfLate.value = [seen[0], ...rejectedOfLate.value].slice(0, rejectedShown);
  }
  tell();
}

async function fetchAll(): Promise<void> {
  if (fetching) return;
  fetching = true;
  waiting = [];
  try {
    const metrics = chartMetrics.join(",");
    history.load(
      await getJson<History>(withQuery("/api/v1/history", { metrics, after: history.last })),
    );
    const { rejected } = await getJson<Rejected>(
      withQuery("/api/v1/rejected", { limit: rejectedShown }),
    );
    rejectedOfLate.value = rejected.filter((attempt) => attempt.id <= history.last);
  } catch (error) {
    // Without a journal there is no history; without a connection it comes with the next one.
    if (!(error instanceof ApiError) && !isAbort(error)) missed = true;
  } finally {
    fetching = false;
    const came = waiting ?? [];
    waiting = null;
    came.forEach(take);
    rejectedCount.value = history.rejectedCount;
    tell();
  }
}

let missed = false;
let begun = false;

/** Begins to collect; from then on it goes on, whatever view is shown. */
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
  void fetchAll();
}
