import type { Status } from "../api/types";
import { askFor, commands } from "../shell/commands";
import { Button } from "../ui/Button";

/** What may be asked of the job now, and nothing else. */
export function Controls({ status, lost }: { status: Status; lost: boolean }) {
  // Of a job that has every layer the daemon would start no more than another check.
  const isWhole = status.state === "done" && status.committed >= status.layers;
  const allowed = commands.filter(
    ({ name }) => status.commands.includes(name) && !(isWhole && name === "start"),
  );
  return (
    <div class="controls button-row" role="group" aria-label="Commands">
      {allowed.map(({ name, label, kind }) => (
        <Button key={name} kind={kind} disabled={lost} onClick={() => askFor(name)}>
          {label}
        </Button>
      ))}
    </div>
  );
}
