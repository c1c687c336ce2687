import type { Status, Window } from "../api/types";
import { fixed, micrometres, withUnit } from "../ui/numbers";
import { InterlockList } from "./InterlockList";
import { fit, windowWords } from "./window_words";

/** What the rig's instruments show. */
export function RigReadings({ status }: { status: Status }) {
  const { stage } = status;
  const limits = status.limits ?? {};
  return (
    <section class="panel rig" aria-label="Rig">
      <h2>Rig</h2>
      <InterlockList status={status} />
      {stage && !stage.answers && (
        <p class="notice notice-warn">The controller does not answer: this is what it said last.</p>
      )}
      {stage ? (
        <dl class="readings">
          <Reading
            name="Block temperature"
            value={stage.temperatures_c.block}
            decimals={1}
            unit="°C"
            window={limits.block_temperature_c}
            low="too cold"
            high="too warm"
          />
          <Reading
            name="Chamber temperature"
            value={stage.temperatures_c.chamber}
            decimals={1}
            unit="°C"
            window={limits.chamber_temperature_c}
            low="too cold"
            high="too warm"
          />
          <Reading
            name="Spindle load"
            value={stage.spindle.load_percent}
            decimals={0}
            unit="%"
            window={limits.spindle_load_percent}
            low="too little"
            high="too much"
          />
          <Reading name="Spindle speed" value={stage.spindle.rpm} decimals={0} unit="rpm" />
          <Reading
            name="Vibration"
            value={stage.vibration_mm_s}
            decimals={2}
            unit="mm/s"
            window={limits.vibration_mm_s}
            low="too little"
            high="too much"
          />
          <Position name="Feed (wheel)" value={stage.positions_um.feed} />
          <Position name="Traverse (0 is under the camera)" value={stage.positions_um.traverse} />
          <Position name="Column (camera)" value={stage.positions_um.column} />
          <Position name="Ground to" value={stage.positions_um.ground_to} />
        </dl>
      ) : (
        <p class="muted">The controller has not answered yet.</p>
      )}
    </section>
  );
}

interface ReadingProps {
  name: string;
  value: number;
  decimals: number;
  unit: string;
  window?: Window | null;
  low?: string;
  high?: string;
}

function Reading({ name, value, decimals, unit, window, low, high }: ReadingProps) {
  const fits = fit(value, window);
  const words = windowWords(window, unit, decimals);
  return (
    <div class="reading" data-fit={fits}>
      <dt>{name}</dt>
      <dd>
        {withUnit(fixed(value, decimals), unit)}
        {fits === "low" && <strong class="bad"> {low}</strong>}
        {fits === "high" && <strong class="bad"> {high}</strong>}
        {words && <small>{words}</small>}
      </dd>
    </div>
  );
}

function Position({ name, value }: { name: string; value: number }) {
  return (
    <div class="reading">
      <dt>{name}</dt>
      <dd>{micrometres(value)}</dd>
    </div>
  );
}
