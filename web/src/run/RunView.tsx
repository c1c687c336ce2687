import "./run.css";
import { useEffect } from "preact/hooks";

import { connection, status } from "../api/live";
import { Connecting } from "../shell/Connecting";
import { durationWords } from "../shell/duration_words";
import { now } from "../shell/now";
import { Charts } from "./Charts";
import { Controls } from "./Controls";
import { LatestFace } from "./LatestFace";
import { Preferences } from "./Preferences";
import { Progress } from "./Progress";
import { RejectedList } from "./RejectedList";
import { RigReadings } from "./RigReadings";
import { StateHeading } from "./StateHeading";
import { collectHistory } from "./run_history";

/** What the rig does, how far it is, and what an operator may do about it. */
export function RunView() {
  useEffect(collectHistory, []);
  const shown = status.value;
  const lost = connection.value.state === "lost";
  return (
    <main id="main" class="view run" data-view="run" data-stale={lost} tabIndex={-1}>
      {shown ? (
        <>
          {lost && <Age />}
          <div class="run-top panel">
            <StateHeading status={shown} />
            <Controls status={shown} lost={lost} />
            <Progress status={shown} />
          </div>
          <div class="run-side">
            <RigReadings status={shown} />
            <LatestFace layer={shown.last_layer?.layer ?? shown.committed} />
            <Preferences status={shown} lost={lost} />
          </div>
          <div class="run-charts panel">
            <Charts />
            <RejectedList />
          </div>
        </>
      ) : (
        <h1>{lost ? "Nothing is known of the rig." : <Connecting />}</h1>
      )}
    </main>
  );
}

function Age() {
  const age_s = (now.value - connection.value.heardAt) / 1000;
  return (
    <p class="run-age notice notice-warn">
      All of this was so {durationWords(age_s)} ago. What the rig does now is not known.
    </p>
  );
}
