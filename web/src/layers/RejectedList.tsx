import { useEffect, useState } from "preact/hooks";

import { getJson, isAbort, sentenceOf, withQuery } from "../api/client";
import { onAttempt, onGap } from "../api/live";
import type { Attempt, Rejected } from "../api/types";
import { Button } from "../ui/Button";
import { fixed } from "../ui/numbers";
import { layerHash } from "./layer_link";
import { useThumbnails } from "./thumbnails";
import { timeText } from "../ui/time_text";
import { isRejected, slugWords } from "../journal/verdict_words";

const pageLength = 50;

/** Every rejected frame, the newest first; each leads to its layer. */
export function RejectedList() {
  const [frames, setFrames] = useState<Attempt[]>([]);
  const [count, setCount] = useState<number | null>(null);
  const [trouble, setTrouble] = useState("");
  const [news, setNews] = useState(0);
  const [wish, setWish] = useState<{ before: number } | null>(null); // for older ones
  const thumbnails = useThumbnails(1000);
  void thumbnails.version.value;

  useEffect(() => {
    const heard = () => setNews((told) => told + 1);
    const stops = [onAttempt(({ verdict }) => isRejected(verdict) && heard()), onGap(heard)];
    return () => stops.forEach((stop) => stop());
  }, []);
  const fetchPage = (older: number | null) => {
    const ended = new AbortController();
    const address = withQuery("/api/v1/rejected", { limit: pageLength, before: older });
    getJson<Rejected>(address, ended.signal).then(
      (answer) => {
        setFrames((known) => (older === null ? newest : merged)(known, answer.rejected));
        setCount(answer.count);
        setTrouble("");
      },
      (error: unknown) => !isAbort(error) && setTrouble(sentenceOf(error)),
    );
    return () => ended.abort();
  };
  useEffect(() => fetchPage(null), [news]);
  // By the wish, not by what it is for: after a failure the same may be wished for again.
  useEffect(() => (wish === null ? undefined : fetchPage(wish.before)), [wish]);
  useEffect(() => {
    thumbnails.want(frames.flatMap((frame) => frame.image ?? []));
  }, [frames]);

  const last = frames[frames.length - 1];
  return (
    <section class="rejected-all" aria-label="Rejected frames">
      {trouble && <p class="notice notice-bad">{trouble}</p>}
      {count === 0 && <p class="muted">No frame has been rejected.</p>}
      <ul class="rejected-frames">
        {frames.map((frame) => (
          <li key={frame.id}>
            <a
              class="rejected-frame"
              href={layerHash({ layer: frame.layer, attempt: frame.attempt })}
            >
              <RejectedPicture
                kept={Boolean(frame.image)}
                url={frame.image ? thumbnails.url(frame.image) : undefined}
              />
              <span>
                <strong>
                  Layer {fixed(frame.layer)}, attempt {frame.attempt}: {slugWords(frame.slug)}
                </strong>
                <span class="rejected-reason">{frame.reason}</span>
                <span class="muted">{timeText(frame.taken_at)}</span>
              </span>
            </a>
          </li>
        ))}
      </ul>
      {last && count !== null && frames.length < count && (
        <Button onClick={() => setWish({ before: last.id })}>Show older ones</Button>
      )}
    </section>
  );
}

function RejectedPicture({ kept, url }: { kept: boolean; url: string | undefined }) {
  return (
    <span class="rejected-picture">
      {url && <img src={url} alt="" />}
      {!kept && <span class="film-note">not kept</span>}
    </span>
  );
}

/** With the newest page; where that does not reach down to what is known, it stands alone. */
function newest(known: Attempt[], page: Attempt[]): Attempt[] {
  const reaches = page.length < pageLength || page.some(({ id }) => id === known[0]?.id);
  return reaches ? merged(known, page) : page;
}

/** Each frame once, the newest first. */
function merged(known: Attempt[], more: Attempt[]): Attempt[] {
  const byId = new Map([...known, ...more].map((frame) => [frame.id, frame]));
  return [...byId.values()].sort((a, b) => b.id - a.id);
}
