import { signal } from "@preact/signals";

import { ConnectionError, postJson } from "../api/client";

/** A command that an operator may give. */
export interface Command {
  name: string;
  label: string;
  kind: "plain" | "primary" | "danger";
  /** What it does, before it is given. */
  about: string;
  /** The word to type before a command is given that gives something up. */
  confirmWord?: string;
}

export const commands: Command[] = [
  {
    name: "start",
    label: "Start",
    kind: "primary",
    about: "The rig is checked, then the job begins, or goes on where its records end.",
  },
  {
    name: "resume",
    label: "Resume",
    kind: "primary",
    about: "The rig is checked, then the job goes on where it paused.",
  },
  {
    name: "pause",
    label: "Pause",
    kind: "plain",
    about: "The step at hand is finished, then the wheel is parked. The job can be resumed.",
  },
  {
    name: "acknowledge",
    label: "Acknowledge",
    kind: "primary",
    about:
      "You have looked at the rig, and what caused the alarm is gone. The controller is reset; nothing is ground before you start or resume.",
  },
  {
    name: "abort",
    label: "Abort",
    kind: "danger",
    about:
      "The wheel stops at once and is parked, and the run ends; a photograph that is being taken is given up. What is stored stays, and Start goes on behind it. Pause stops the rig without giving anything up.",
    confirmWord: "abort",
  },
];

/** Those that see to the camera between two jobs. */
export const calibrations: Command[] = [
  {
    name: "calibrate-focus",
    label: "Find the focus",
    kind: "plain",
    about: "The camera looks for its focus on the face as it is.",
  },
  {
    name: "calibrate-flat",
    label: "Measure evenness of light",
    kind: "plain",
    about: "Photographs of an even surface: put one where the block's face is.",
  },
  {
    name: "calibrate-dark",
    label: "Measure darkness",
    kind: "plain",
    about: "Photographs without light: cover the lens.",
  },
  {
    name: "calibrate-white",
    label: "Measure white",
    kind: "plain",
    about: "Photographs of a white surface: put one where the block's face is.",
  },
];

/** The command whose dialog is open. */
export const commandAsked = signal<Command | null>(null);

export function askFor(name: string): void {
  commandAsked.value =
    [...commands, ...calibrations].find((command) => command.name === name) ?? null;
}

/** The server's sentence on what is done now. Throws an error whose message says why it is not. */
export async function give(command: Command, reason: string): Promise<string> {
  const body = reason.trim() ? { reason: reason.trim() } : {};
  const path = `/api/v1/control/${command.name}`;
  try {
    return (await postJson<{ message: string }>(path, body)).message;
  } catch (error) {
    if (!(error instanceof ConnectionError)) throw error;
    throw new Error(`${error.message} The rig’s state will show whether the command arrived.`);
  }
}
