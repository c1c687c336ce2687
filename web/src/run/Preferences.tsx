import type { Status } from "../api/types";
import { soundWanted, wantSound } from "../shell/alarm_sound";
import { askFor, calibrations } from "../shell/commands";
import { Button } from "../ui/Button";
import { Switch } from "../ui/Switch";

/** What one does now and then: the sound of alarms, calibrations. */
export function Preferences({ status, lost }: { status: Status; lost: boolean }) {
  const allowed = calibrations.filter(({ name }) => status.commands.includes(name));
  const { calibration } = status;
  return (
    <section class="panel preferences" aria-label="More">
      <Switch checked={soundWanted.value} onChange={wantSound}>
        Sound an alarm on this computer
      </Switch>
      {calibration && (
        <p class={calibration.progress === "failed" ? "notice notice-bad" : "notice"} role="status">
          Calibration ({calibration.kind}): {calibration.sentence}
        </p>
      )}
      {allowed.length > 0 && (
        <details>
          <summary>Calibrate the camera</summary>
          <div class="button-row">
            {allowed.map(({ name, label }) => (
              <Button key={name} disabled={lost} onClick={() => askFor(name)}>
                {label}
              </Button>
            ))}
          </div>
        </details>
      )}
    </section>
  );
}
