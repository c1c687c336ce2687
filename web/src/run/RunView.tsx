import { status } from "../api/live";
import { stateSentence } from "../shell/state_words";

export function RunView() {
  const now = status.value;
  return (
    <main id="main" class="view" data-view="run" tabIndex={-1}>
      <h1>{now ? stateSentence(now) : "Connecting…"}</h1>
    </main>
  );
}
