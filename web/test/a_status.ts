import type { Alarm, Status } from "../src/api/types";

/** The status of a rig at rest, with what a test changes of it. */
export function aStatus(changes: Partial<Status>): Status {
  return {
    version: "0.1.0",
    state: "idle",
    waiting_for: "",
    pause_requested: false,
    pause_cause: "",
    job: "knee",
    sample: "/data/knee",
    layer: 0,
    layers: 80,
    committed: 0,
    attempt: 0,
    seconds_left: null,
    seconds_left_range: null,
    stage: null,
    interlocks: { lines: { estop_pressed: false, door_open: false }, controller: null },
    last_layer: null,
    last_attempt: null,
    focus: null,
    disk_left_layers: null,
    alarm: null,
    calibration: null,
    volume: { layers_present: 0, finished: false, failure: "" },
    limits: {},
    commands: [],
    ...changes,
  };
}

export const anAlarm: Alarm = {
  cause: "the door is open",
  since: "2024-05-01T10:00:00Z",
  state: "grinding",
  kind: "door",
  advice: "Close the door, then acknowledge.",
};
