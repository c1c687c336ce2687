import type { StageStatus, Status } from "../api/types";
import { fixed, withUnit } from "../ui/numbers";
import { InterlockList } from "./InterlockList";
import { fit, windowWords } from "./window_words";

interface Instrument {
  name: string;
  value: (stage: StageStatus) => number;
  decimals: number;
  unit: string;
  /** In the status's `limits`; without one nothing is too low or too high. */
  limit?: string;
  /** What a value outside the limit is. */
  outside?: { low: string; high: string };
}

const temperature = { low: "too cold", high: "too warm" };
const strain = { low: "too little", high: "too much" };

const instruments: Instrument[] = [
  {
    name: "Block temperature",
    value: ({ temperatures_c }) => temperatures_c.block,
    decimals: 1,
    unit: "°C",
    limit: "block_temperature_c",
    outside: temperature,
  },
  {
    name: "Chamber temperature",
    value: ({ temperatures_c }) => temperatures_c.chamber,
    decimals: 1,
    unit: "°C",
    limit: "chamber_temperature_c",
    outside: temperature,
  },
  {
    name: "Spindle load",
    value: ({ spindle }) => spindle.load_percent,
    decimals: 0,
    unit: "%",
    limit: "spindle_load_percent",
    outside: strain,
  },
  { name: "Spindle speed", value: ({ spindle }) => spindle.rpm, decimals: 0, unit: "rpm" },
  {
    name: "Vibration",
    value: ({ vibration_mm_s }) => vibration_mm_s,
    decimals: 2,
    unit: "mm/s",
    limit: "vibration_mm_s",
    outside: strain,
  },
  position("Feed (wheel)", "feed"),
  position("Traverse (0 is under the camera)", "traverse"),
  position("Column (camera)", "column"),
  position("Ground to", "ground_to"),
];

function position(name: string, axis: keyof StageStatus["positions_um"]): Instrument {
  return { name, value: ({ positions_um }) => positions_um[axis], decimals: 1, unit: "µm" };
}

/** What the rig's instruments show. */
export function RigReadings({ status }: { status: Status }) {
  const { stage, limits } = status;
  return (
    <section class="panel rig" aria-label="Rig">
      <h2>Rig</h2>
      <InterlockList status={status} />
      {stage && !stage.answers && (
        <p class="notice notice-warn">The controller does not answer: this is what it said last.</p>
      )}
      {stage ? (
        <dl class="readings">
          {instruments.map((instrument) => (
            <Reading key={instrument.name} instrument={instrument} stage={stage} limits={limits} />
          ))}
        </dl>
      ) : (
        <p class="muted">The controller has not answered yet.</p>
      )}
    </section>
  );
}

interface ReadingProps {
  instrument: Instrument;
  stage: StageStatus;
  limits: Status["limits"];
}

function Reading({ instrument, stage, limits }: ReadingProps) {
  const { name, decimals, unit, limit, outside } = instrument;
  const value = instrument.value(stage);
  const window = limit === undefined ? null : limits[limit];
  const fits = fit(value, window);
  const words = windowWords(window, unit, decimals);
  return (
    <div class="reading" data-fit={fits}>
      <dt>{name}</dt>
      <dd>
        {withUnit(fixed(value, decimals), unit)}
        {(fits === "low" || fits === "high") && <strong class="bad"> {outside?.[fits]}</strong>}
        {words && <small>{words}</small>}
      </dd>
    </div>
  );
}
