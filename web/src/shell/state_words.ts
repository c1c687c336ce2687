import type { JobState, Status } from "../api/types";
import { fixed } from "../ui/numbers";

/** How the state is told at a glance: by colour. */
export type Mood = "resting" | "working" | "waiting" | "alarm";

interface Words {
  short: string; // for the header
  sentence: string; // for the operator, who was not there when it began
  mood: Mood;
}

export const stateWords: Record<JobState, Words> = {
  idle: { short: "Ready", sentence: "The rig is ready. No job is running.", mood: "resting" },
  preflight: {
    short: "Checking",
    sentence: "The rig is checked before it starts.",
    mood: "working",
  },
  recovering: {
    short: "Finding its place",
    sentence: "The records and the controller are compared, to go on where the work stopped.",
    mood: "working",
  },
  homing: { short: "Homing", sentence: "The axes look for their zero.", mood: "working" },
  conditioning: {
    short: "Cooling",
    sentence: "The block is brought to its temperature.",
    mood: "waiting",
  },
  grinding: { short: "Grinding", sentence: "The wheel grinds the next layer.", mood: "working" },
  retracting: {
    short: "Parking",
    sentence: "The wheel draws back from the face.",
    mood: "working",
  },
  clearing: {
    short: "Clearing",
    sentence: "The face is blown clean.",
    mood: "working",
  },
  settling: {
    short: "Settling",
    sentence: "The rig comes to rest before the photograph.",
    mood: "working",
  },
  lighting: { short: "Lighting", sentence: "The lamp warms up.", mood: "working" },
  focusing: { short: "Focusing", sentence: "The camera is focused on the face.", mood: "working" },
  capturing: { short: "Photographing", sentence: "The face is photographed.", mood: "working" },
  assessing: { short: "Judging", sentence: "The photograph is judged.", mood: "working" },
  storing: { short: "Storing", sentence: "The photograph is stored safely.", mood: "working" },
  pausing: { short: "Pausing", sentence: "The wheel is parked for a pause.", mood: "waiting" },
  withdrawing: {
    short: "Withdrawing",
    sentence: "The wheel is stopped and parked until the rig is fit to go on.",
    mood: "waiting",
  },
  finishing: {
    short: "Finishing",
    sentence: "The last layer is stored; the wheel is parked and the volume completed.",
    mood: "working",
  },
  aborting: {
    short: "Aborting",
    sentence: "The job is ended: the wheel is stopped and parked.",
    mood: "waiting",
  },
  held: {
    short: "Held",
    sentence: "The job waits, and goes on by itself as soon as the rig is fit again.",
    mood: "waiting",
  },
  paused: { short: "Paused", sentence: "The job is paused.", mood: "waiting" },
  done: { short: "Done", sentence: "The job is done: every layer is stored.", mood: "resting" },
  aborted: {
    short: "Aborted",
    sentence: "The job was aborted.",
    mood: "resting",
  },
  faulted: {
    short: "Stopped",
    sentence: "The rig has stopped and waits for you.",
    mood: "alarm",
  },
  resetting: { short: "Resetting", sentence: "The controller is being reset.", mood: "waiting" },
};

/** A state that this page does not know is told as it is. */
export const wordsOf = (state: JobState): Words =>
  stateWords[state] ?? { short: state, sentence: `The job is ${state}.`, mood: "waiting" };

/**
 * True for the alarm that the program starts with: nothing went wrong, but nothing moves before
 * somebody has looked.
 */
export function isStartLatch({ alarm }: Status): boolean {
  return alarm?.kind === "start_latch";
}

const startStates: ReadonlySet<JobState> = new Set(["idle", "aborted"]);

/** Where a job that was begun goes on; empty for one that was not, or has every layer. */
function whereItGoesOn({ committed, layers }: Status): string {
  return committed > 0 && committed < layers
    ? `Start goes on behind layer ${fixed(committed)}.`
    : "";
}

/** The whole of it in a sentence or two. */
export function stateSentence(status: Status): string {
  if (status.state === "faulted" && isStartLatch(status)) {
    const started = "The daemon has just started and waits for you to acknowledge.";
    return `${started} ${whereItGoesOn(status)}`.trim();
  }
  const { sentence } = wordsOf(status.state);
  if (status.pause_requested && status.state !== "pausing" && status.state !== "paused") {
    return `${sentence} It pauses when this step is done.`;
  }
  if (startStates.has(status.state)) return `${sentence} ${whereItGoesOn(status)}`.trim();
  return sentence;
}

/** An alarm comes before what the job does; the latch of the start is none. */
export function moodOf(status: Status): Mood {
  if (isStartLatch(status)) return "waiting";
  return status.alarm ? "alarm" : wordsOf(status.state).mood;
}
