import type { Status } from "../api/types";
import { capital } from "../shell/capital";
import { moodOf, stateSentence } from "../shell/state_words";
import { obstacleWords } from "./obstacles";

/** What the rig is about, and what it waits for. */
export function StateHeading({ status }: { status: Status }) {
  const saidByAlarmBar = status.alarm && !status.commands.includes("acknowledge");
  const waiting = status.waiting_for && !saidByAlarmBar && `${capital(status.waiting_for)}.`;
  // The reason for a pause is part of what a paused job waits for.
  const cause = status.waiting_for.includes(status.pause_cause) ? "" : status.pause_cause;
  const obstacles = obstacleWords(status);
  return (
    <div class="state-heading" data-mood={moodOf(status)}>
      <h1 data-role="state-sentence" data-state={status.state}>
        {stateSentence(status)}
      </h1>
      <p data-role="waiting-for">{waiting}</p>
      {obstacles && (
        <p class="notice notice-warn" data-role="obstacles">
          {obstacles}
        </p>
      )}
      {cause && <p class="notice notice-warn">{capital(cause)}.</p>}
      {status.volume.failure && (
        <p class="notice notice-bad">The volume does not grow: {status.volume.failure}.</p>
      )}
    </div>
  );
}
