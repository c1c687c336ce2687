import type { Status } from "../api/types";
import { askFor, commands } from "../shell/commands";
import { Button } from "../ui/Button";

/** What may be asked of the job now, and nothing else. */
export function Controls({ status, lost }: { status: Status; lost: boolean }) {
  const allowed = commands.filter(({ name }) => status.commands.includes(name));
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
