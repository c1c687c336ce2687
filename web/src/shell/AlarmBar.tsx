import { status } from "../api/live";
import { Button } from "../ui/Button";
import { Switch } from "../ui/Switch";
import { alarmKey, silence, silenced, soundBlocked, soundWanted, wantSound } from "./alarm_sound";
import { askFor } from "./commands";
import { capital } from "./capital";
import { durationWords } from "./duration_words";
import { now } from "./now";
import { isStartLatch, wordsOf } from "./state_words";

/** On every view as long as there is an alarm: what happened, what to do, since when. */
export function AlarmBar() {
  const shown = status.value;
  if (!shown?.alarm) return null;
  const { cause, advice, since, state } = shown.alarm;
  const isStart = isStartLatch(shown);
  return (
    <section class="alarm-bar" data-kind={isStart ? "start" : "alarm"} aria-label="Alarm">
      <AlarmSign />
      <div role="alert">
        <p class="alarm-cause">{isStart ? capital(cause) : `Alarm: ${cause}`}</p>
        <p class="alarm-advice">{advice}</p>
        <p class="alarm-since">
          {isStart ? "" : `While the rig was ${wordsOf(state).short.toLowerCase()}, `}
          {isStart ? "Since" : "since"} <Since time={since} />
        </p>
      </div>
      <div class="alarm-actions">
        <SoundSwitch />
        {shown.commands.includes("acknowledge") && (
          <Button onClick={() => askFor("acknowledge")}>Acknowledge…</Button>
        )}
      </div>
    </section>
  );
}

function AlarmSign() {
  return (
    <svg class="alarm-sign" viewBox="0 0 32 32" aria-hidden="true">
      <path d="M16 1 31 30H1z" fill="currentColor" />
      <path d="M16 11v9m0 4v3" class="alarm-sign-mark" />
    </svg>
  );
}

/** The time on this computer's clock, and how long ago: only the first is read aloud. */
function Since({ time }: { time: string }) {
  const at = Date.parse(time);
  if (Number.isNaN(at)) return <>{time}</>;
  const words = new Date(at).toLocaleString([], {
    dateStyle: "medium",
    timeStyle: "medium",
    hourCycle: "h23",
  });
  return (
    <>
      <time dateTime={time}>{words}</time>
      <span aria-hidden="true"> ({durationWords((now.value - at) / 1000)} ago)</span>
    </>
  );
}

function SoundSwitch() {
  const key = alarmKey(status.value);
  if (!key) return null;
  const sounds = soundWanted.value && silenced.value !== key;
  return (
    <>
      {sounds && soundBlocked.value && <span>Touch the page to let the sound play.</span>}
      {sounds ? (
        <Button onClick={silence}>Silence</Button>
      ) : (
        !soundWanted.value && (
          <Switch checked={false} onChange={wantSound}>
            Sound
          </Switch>
        )
      )}
    </>
  );
}
