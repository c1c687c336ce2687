import type { Attempt, LayerDetail } from "../api/types";
import { isRejected, verdictWords } from "../journal/verdict_words";

/** The attempt that a link names; else the one that became the layer, or the last. */
export function chosenAttempt(
  detail: LayerDetail | null,
  number: number | null,
  rejectedFirst: boolean,
): Attempt | null {
  const attempts = [...(detail?.attempts ?? [])].reverse();
  const accepted = attempts.find(({ verdict }) => verdictWords(verdict).accepted);
  const rejected = attempts.find(({ verdict }) => isRejected(verdict));
  const usual = (rejectedFirst && rejected) || accepted || attempts[0];
  return attempts.find(({ attempt }) => attempt === number) ?? usual ?? null;
}
