/** What the server answers with. Lengths are micrometres unless a name says otherwise. */

export type JobState =
  | "idle"
  | "preflight"
  | "recovering"
  | "homing"
  | "conditioning"
  | "grinding"
  | "retracting"
  | "clearing"
  | "settling"
  | "lighting"
  | "focusing"
  | "capturing"
  | "assessing"
  | "storing"
  | "pausing"
  | "withdrawing"
  | "finishing"
  | "aborting"
  | "held"
  | "paused"
  | "done"
  | "aborted"
  | "faulted"
  | "resetting";

/** From the least to the largest; null where there is no limit. */
export type Window = [number | null, number | null];

export interface Metric {
  name: string;
  value: number | null;
  limit: number | null;
  passed: boolean;
}

export interface Alarm {
  cause: string;
  since: string; // ISO 8601, UTC
  state: JobState; // in which it came; "faulted": the latch of the start
  advice: string;
  kind: string; // what it is about; "start_latch": nothing happened, the program has just started
}

export interface StageStatus {
  answers: boolean;
  controller_state: string;
  positions_um: { feed: number; traverse: number; column: number; ground_to: number };
  grind_count: number;
  spindle: { rpm: number; load_percent: number };
  vibration_mm_s: number;
  temperatures_c: { block: number; chamber: number };
}

export interface Interlocks {
  lines: { estop_pressed: boolean; door_open: boolean };
  controller: {
    estop_pressed: boolean;
    door_open: boolean;
    watchdog_tripped: boolean;
    homed: boolean;
  } | null;
}

export interface LastAttempt {
  id: number;
  layer: number;
  attempt: number;
  verdict: string;
  slug: string;
  reason: string;
}

export interface Status {
  version: string;
  state: JobState;
  waiting_for: string;
  pause_requested: boolean;
  pause_cause: string;
  job: string;
  sample: string;
  layer: number; // in work; 0 when none is
  layers: number; // of the whole job
  committed: number;
  attempt: number;
  seconds_left: number | null;
  seconds_left_range: [number, number] | null;
  stage: StageStatus | null;
  interlocks: Interlocks;
  last_layer: {
    layer: number;
    attempt: number;
    verdict: string;
    reason: string;
    metrics: Metric[];
  } | null;
  last_attempt: LastAttempt | null;
  focus: {
    layer: number;
    why: string;
    found: boolean;
    why_not: string;
    actuator: string;
    position: string; // with its unit
    plane_um: number;
    frames: number;
  } | null;
  disk_left_layers: number | null;
  alarm: Alarm | null;
  calibration: { kind: string; progress: "running" | "done" | "failed"; sentence: string } | null;
  volume: { layers_present: number; finished: boolean; failure: string };
  limits: { [quantity: string]: Window | null };
  commands: string[];
}

export interface Service {
  version: string;
  kind: "rig" | "view";
  reading: "open" | "token";
  sample: string;
  commands_need_token: boolean;
  neuroglancer: string | null;
}

/** A frame that was taken and judged. */
export interface Attempt {
  id: number;
  layer: number;
  attempt: number;
  taken_at: string;
  verdict: string;
  slug: string; // the reason, in a word or two joined by hyphens
  reason: string;
  metrics: Metric[];
  column_um: number | null;
  exposure_us?: number | null;
  gain?: number | null;
  file: string | null;
  image?: string | null; // where it is to be had
}

export interface LayerDetail {
  layer: number;
  present: boolean; // stored; else only its attempts are known, and file, bytes, sha256 are null
  committed_at: string | null;
  flagged: boolean;
  file: string;
  bytes: number;
  sha256: string;
  width: number; // pixels of the image, as the height
  height: number;
  image: string | null; // where it is to be had
  attempts: Attempt[];
}

export interface Rejected {
  count: number;
  rejected: Attempt[]; // the newest first
}

export interface Sharpness {
  layer: number;
  columns: number;
  rows: number;
  tile_width: number; // pixels of the image, as the height
  tile_height: number;
  measure: string;
  values: (number | null)[]; // row by row; null where there is nothing to measure
}

/** Every attempt of the job, in order, as columns of equal length. */
export interface History {
  last: number;
  id: number[];
  layer: number[];
  attempt: number[];
  verdict: string[];
  column_um: (number | null)[];
  taken_at: string[];
  metrics: { [name: string]: { value: (number | null)[]; limit: (number | null)[] } };
}

export interface Sample {
  name: string;
  notes: string;
  size: [number, number, number];
  spacing_um: [number, number, number];
  bits: number;
  layers_planned: number;
  committed: number;
  layers_present: number;
  levels: { size: [number, number, number]; spacing_um: [number, number, number] }[];
  generation: number;
  volume_url: string;
}

/** How far the sample has grown; `generation` rises whenever its layers or its volume changed. */
export interface SampleProgress {
  committed: number;
  layers_present: number;
  created: string | null; // when it was begun: another of the same name was begun at another time
  generation: number;
}

export interface ExportJob {
  id: string | number;
  kind: "section" | "series";
  state: "queued" | "running" | "done" | "failed" | "cancelled";
  done: number;
  total: number;
  unit: "rows" | "frames";
  seconds_left: number | null;
  sentence: string;
  created_at: string;
  command: string;
  files: { name: string; bytes: number; url: string }[];
}
