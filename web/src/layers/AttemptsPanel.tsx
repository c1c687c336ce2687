import type { Attempt, LayerDetail } from "../api/types";
import { capital } from "../shell/capital";
import { bytes, fixed, micrometres, withUnit } from "../ui/numbers";
import { MetricTable } from "./MetricTable";
import { depthText } from "./sample_place";
import { timeText } from "../ui/time_text";
import { slugWords, verdictWords } from "../journal/verdict_words";

interface Props {
  layer: number;
  thicknessUm: number;
  detail: LayerDetail | null;
  trouble: string;
  chosen: Attempt | null;
  onChoose: (attempt: Attempt) => void;
}

/** What is known of a layer, and of each attempt at it. */
export function AttemptsPanel({ layer, thicknessUm, detail, trouble, chosen, onChoose }: Props) {
  return (
    <section class="layer-facts" aria-label={`Layer ${layer}`}>
      <h2 class="layer-number">Layer {fixed(layer)}</h2>
      <p class="muted">
        {depthText(layer, thicknessUm)} below the first face
        {detail?.committed_at && <>, stored {timeText(detail.committed_at)}</>}
        {detail && detail.bytes > 0 && <> ({bytes(detail.bytes)})</>}
      </p>
      {trouble && <p class="notice notice-bad">{trouble}</p>}
      {detail?.flagged && (
        <p class="notice notice-warn">
          ⚑ Accepted with a flag: it was not good enough, and kept because the settings say so.
        </p>
      )}
      {detail && !detail.committed_at && detail.attempts.length > 0 && (
        <p class="notice notice-warn">No attempt at this layer has been accepted yet.</p>
      )}
      {detail && detail.attempts.length === 0 && (
        <p class="notice">
          This sample was imported from images: it has no journal, so there are no measurements and
          no verdicts. The images themselves are all here.
        </p>
      )}
      {detail && detail.attempts.length > 0 && (
        <ul class="attempts" aria-label="Attempts">
          {detail.attempts.map((attempt) => (
            <li key={attempt.id}>
              <AttemptButton
                attempt={attempt}
                chosen={attempt.id === chosen?.id}
                onChoose={onChoose}
              />
            </li>
          ))}
        </ul>
      )}
      {chosen && <AttemptFacts attempt={chosen} />}
    </section>
  );
}

interface ButtonProps {
  attempt: Attempt;
  chosen: boolean;
  onChoose: (attempt: Attempt) => void;
}

function AttemptButton({ attempt, chosen, onChoose }: ButtonProps) {
  const { title, mark } = verdictWords(attempt.verdict);
  return (
    <button
      type="button"
      class="attempt"
      data-mark={mark}
      data-attempt={attempt.attempt}
      data-verdict={attempt.verdict}
      aria-pressed={chosen}
      onClick={() => onChoose(attempt)}
    >
      <span class="attempt-title">
        <span>Attempt {attempt.attempt}</span>
        <span>
          {title}
          {mark !== "good" && attempt.slug && `: ${slugWords(attempt.slug)}`}
        </span>
      </span>
      <span class="attempt-reason">{sentence(attempt.reason)}</span>
    </button>
  );
}

function AttemptFacts({ attempt }: { attempt: Attempt }) {
  const facts = [
    `Taken ${timeText(attempt.taken_at)}`,
    attempt.column_um !== null && `camera at ${micrometres(attempt.column_um, 1)}`,
    attempt.exposure_us && `exposed ${withUnit(fixed(attempt.exposure_us / 1000, 1), "ms")}`,
    attempt.gain && attempt.gain !== 1 && `gain ${fixed(attempt.gain, 1)}`,
  ].filter(Boolean);
  return (
    <>
      <p class="muted">{facts.join(", ")}.</p>
      <MetricTable metrics={attempt.metrics} />
    </>
  );
}

function sentence(text: string): string {
  const whole = capital(text);
  return /[.!?]$/.test(whole) ? whole : `${whole}.`;
}
