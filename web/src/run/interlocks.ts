import type { Status } from "../api/types";

/** One thing that must be good before anything moves. */
export interface Interlock {
  name: string;
  words: string;
  good: boolean | null; // null: not known
}

/**
 * As the operator thinks of them. E-stop and door are wired twice, to the computer and to the
 * controller: where the two disagree, that is said.
 */
export function interlocksOf(status: Status): Interlock[] {
  const { lines } = status.interlocks;
  const answers = status.stage?.answers ?? false;
  // What a silent controller said before is not known to be so now.
  const controller = answers ? status.interlocks.controller : null;
  const isFaulted = status.stage?.controller_state === "faulted";
  return [
    twice("E-stop", lines.estop_pressed, controller?.estop_pressed, "pressed", "released"),
    twice("Door", lines.door_open, controller?.door_open, "open", "closed"),
    {
      name: "Controller",
      words: !answers ? "does not answer" : isFaulted ? "is in a fault" : "answers",
      good: answers && !isFaulted,
    },
    controller
      ? {
          name: "Watchdog",
          words: controller.watchdog_tripped ? "has stopped the rig" : "has not tripped",
          good: !controller.watchdog_tripped,
        }
      : { name: "Watchdog", words: "not known", good: null },
    controller
      ? {
          name: "Axes",
          words: controller.homed ? "homed" : "not homed yet",
          // The job homes them by itself: it is nothing to put right.
          good: controller.homed ? true : null,
        }
      : { name: "Axes", words: "not known", good: null },
  ];
}

function twice(
  name: string,
  line: boolean,
  controller: boolean | undefined,
  bad: string,
  good: string,
): Interlock {
  if (controller === undefined || line === controller) {
    return { name, words: line ? bad : good, good: !line };
  }
  const seenBy = line ? "by its own wire" : "by the controller";
  return { name, words: `${bad}, ${seenBy} alone`, good: false };
}
