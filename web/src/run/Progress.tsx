import type { Status } from "../api/types";
import { now } from "../shell/now";
import { fixed } from "../ui/numbers";
import { timeLeft } from "./eta_words";

/** How far the job is, when it ends, and whether the disk lasts so long. */
export function Progress({ status }: { status: Status }) {
  const { layers, committed } = status;
  const left = timeLeft(status.seconds_left, status.seconds_left_range, now.value);
  return (
    <div class="progress">
      <p class="progress-layer" data-role="layer" data-committed={committed}>
        {layerWords(status)}
      </p>
      {rejection(status) && (
        <p class="notice notice-bad" data-role="last-rejection">
          {rejection(status)}
        </p>
      )}
      <progress
        class="progress-bar"
        aria-label="Layers stored"
        max={Math.max(1, layers)}
        value={committed}
        aria-valuemax={Math.max(1, layers)}
        aria-valuenow={committed}
      />
      <dl class="facts">
        <Fact name="Stored safely">
          {fixed(committed)} of {fixed(layers)}
        </Fact>
        <Fact name="Time left" role="time-left">
          {left.words ?? (status.state === "done" ? "none" : "not known yet")}
          {left.range && <small>{left.range}</small>}
        </Fact>
        <Fact name="Ends" role="end-time">
          {left.end ?? "–"}
        </Fact>
        <DiskFact status={status} />
      </dl>
    </div>
  );
}

function layerWords({ state, layer, layers, committed, attempt }: Status): string {
  const atWork = state !== "idle" && state !== "done" && state !== "aborted";
  if (atWork && layer > 0 && committed < layers) {
    const tries = attempt > 1 ? `, attempt ${attempt}` : "";
    return `Layer ${fixed(layer)} of ${fixed(layers)}${tries}`;
  }
  return `${fixed(committed)} of ${fixed(layers)} layers`;
}

/** Why the layer at hand needs another photograph. */
function rejection({ layer, last_attempt: last }: Status): string | null {
  if (!last || last.layer !== layer || last.verdict !== "rejected") return null;
  return `Attempt ${last.attempt} was rejected: ${last.reason}.`;
}

function DiskFact({ status }: { status: Status }) {
  const room = status.disk_left_layers;
  const short = room !== null && room < status.layers - status.committed;
  return (
    <Fact name="Room on the disk" role="disk">
      {room === null ? "–" : `${fixed(room)} layers`}
      {short && <small class="bad">less than the job still needs</small>}
    </Fact>
  );
}

interface FactProps {
  name: string;
  role?: string;
  children: preact.ComponentChildren;
}

function Fact({ name, role, children }: FactProps) {
  return (
    <div class="fact" data-role={role}>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </div>
  );
}
