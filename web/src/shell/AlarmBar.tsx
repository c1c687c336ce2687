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
  const mayAcknowledge = shown.commands.includes("acknowledge");
  return (
    <section class="alarm-bar" data-kind={isStart ? "start" : "alarm"} aria-label="Alarm">
      <AlarmSign />
      <div role="alert">
        <AlarmCause prefix={isStart ? "" : "Alarm: "} cause={isStart ? capital(cause) : cause} />
        <p class="alarm-advice">{advice}</p>
        {!mayAcknowledge && shown.waiting_for && (
          <p class="alarm-waiting">{capital(shown.waiting_for)}.</p>
        )}
        <p class="alarm-since">
          {isStart ? "" : `While the rig was ${wordsOf(state).short.toLowerCase()}, `}
          {isStart ? "Since" : "since"} <Since time={since} />
        </p>
      </div>
      <div class="alarm-actions">
        <SoundSwitch />
        {mayAcknowledge && <Button onClick={() => askFor("acknowledge")}>Acknowledge…</Button>}
      </div>
    </section>
  );
}

/** What it is about stands out; what a device says of it, with its address, need not. */
function AlarmCause({ prefix, cause }: { prefix: string; cause: string }) {
  const [what, ...details] = cause.split(/(?=: )/);
  return (
    <p class="alarm-cause">
      {prefix}
      {what}
      {details.length > 0 && <span class="alarm-details">{details.join("")}</span>}
    </p>
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
