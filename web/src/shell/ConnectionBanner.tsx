import { useEffect } from "preact/hooks";

import { connection, reconnect } from "../api/live";
import { Button } from "../ui/Button";
import { durationWords } from "./duration_words";
import { now } from "./now";

/** Says at once that what is shown is not what is, and since when. */
export function ConnectionBanner() {
  const { state, why, since, heardAt, retryAt } = connection.value;

  useEffect(() => {
    document.body.dataset.connection = state;
  }, [state]);

  return (
    <div class="connection-banner" role="status" aria-live="polite">
      {state === "lost" && (
        <>
          <strong>{heardAt > 0 ? "Connection lost" : "Not connected"}</strong>
          <span>
            {why} <LostFor since={since} retryAt={retryAt} />
          </span>
          <Button onClick={reconnect}>Try now</Button>
        </>
      )}
    </div>
  );
}

/** Not read aloud each second. */
function LostFor({ since, retryAt }: { since: number; retryAt: number }) {
  const lost_s = (now.value - since) / 1000;
  const wait_s = Math.ceil((retryAt - now.value) / 1000);
  return (
    <span aria-hidden="true">
      For {durationWords(lost_s)} now; {wait_s > 0 ? `tried again in ${wait_s} s.` : "being tried."}
    </span>
  );
}
