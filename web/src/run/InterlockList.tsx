import type { Status } from "../api/types";
import { interlocksOf } from "./interlocks";

export function InterlockList({ status }: { status: Status }) {
  return (
    <ul class="interlocks" aria-label="Interlocks">
      {interlocksOf(status).map(({ name, words, good }) => (
        <li key={name} class="interlock" data-good={good === null ? "unknown" : good}>
          <span class="interlock-sign" aria-hidden="true">
            {good === null ? "–" : good ? "✓" : "✕"}
          </span>
          <span class="interlock-name">{name}</span> <span>{words}</span>
        </li>
      ))}
    </ul>
  );
}
