import { effect, untracked } from "@preact/signals";

import { connection } from "../api/live";

/** Calls when the connection is back after it was lost or given up; returns what ends it. */
export function onBack(call: () => void): () => void {
  let away = false;
  return effect(() => {
    const { state } = connection.value;
    if (state === "lost" || state === "resting") away = true;
    else if (state === "live" && away) {
      away = false;
      untracked(call);
    }
  });
}
