/** What the journal says of each layer, as far as the film strip marks it. */

export interface LayerMark {
  /** Attempts that were rejected. */
  readonly rejected: number;
  /** Accepted although not good enough. */
  readonly flagged: boolean;
  /** Some attempt was accepted. */
  readonly accepted: boolean;
}

export interface JudgedAttempt {
  readonly id: number;
  readonly layer: number;
  readonly verdict: string;
}

/** Marks by layer; `last` is the newest attempt that went into them. */
export interface LayerMarks {
  readonly byLayer: ReadonlyMap<number, LayerMark>;
  readonly last: number;
}

export const noMarks: LayerMarks = { byLayer: new Map(), last: 0 };

const unmarked: LayerMark = { rejected: 0, flagged: false, accepted: false };

/** The marks with further attempts; those that are in them already are passed over. */
export function marksWith(marks: LayerMarks, attempts: Iterable<JudgedAttempt>): LayerMarks {
  const byLayer = new Map(marks.byLayer);
  let last = marks.last;
  for (const attempt of attempts) {
    if (attempt.id <= marks.last) continue;
    last = Math.max(last, attempt.id);
    byLayer.set(attempt.layer, markWith(byLayer.get(attempt.layer) ?? unmarked, attempt.verdict));
  }
  return last === marks.last ? marks : { byLayer, last };
}

function markWith(mark: LayerMark, verdict: string): LayerMark {
  switch (verdict) {
    case "rejected":
      return { ...mark, rejected: mark.rejected + 1 };
    case "accepted_with_flag":
      return { ...mark, flagged: true, accepted: true };
    case "accepted":
      return { ...mark, accepted: true };
    default:
      return mark;
  }
}

/** The layer of the highest number that has an attempt; 0 without one. */
export function highestMarked(marks: LayerMarks): number {
  let highest = 0;
  for (const layer of marks.byLayer.keys()) highest = Math.max(highest, layer);
  return highest;
}
