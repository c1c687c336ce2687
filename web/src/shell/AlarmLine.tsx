import { status } from "../api/live";
import { isStartLatch } from "./state_words";

/** An alarm where the bar can't be seen: in a dialog. */
export function AlarmLine() {
  const shown = status.value;
  if (!shown?.alarm || isStartLatch(shown)) return null;
  return (
    <p class="alarm-line" role="alert">
      Alarm: {shown.alarm.cause}
    </p>
  );
}
