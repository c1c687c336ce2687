import type { JobState, Status } from "../api/types";
import { interlocksOf } from "./interlocks";

/** What an operator of a rig at rest would do next. */
const next: Partial<Record<JobState, string>> = {
  idle: "Before you start",
  paused: "Before you resume",
  aborted: "Before you start",
  done: "Before anything moves",
};

/**
 * What is to be put right before a rig at rest may move again: "Before you resume: e-stop pressed."
 * Empty where nothing is, and while an alarm says it.
 */
export function obstacleWords(status: Status): string {
  const before = next[status.state];
  const bad = interlocksOf(status).filter(({ good }) => good === false);
  if (!before || status.alarm || bad.length === 0) return "";
  return `${before}: ${bad.map(({ name, words }) => `${name.toLowerCase()} ${words}`).join("; ")}.`;
}
