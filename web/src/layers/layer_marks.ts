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

/** Marks by layer, and the attempts that went into them. */
export interface LayerMarks {
  readonly byLayer: ReadonlyMap<number, LayerMark>;
  readonly ids: ReadonlySet<number>;
}

export const noMarks: LayerMarks = { byLayer: new Map(), ids: new Set() };

const unmarked: LayerMark = { rejected: 0, flagged: false, accepted: false };

/** The marks with further attempts, in any order; those that are in them are passed over. */
export function marksWith(marks: LayerMarks, attempts: Iterable<JudgedAttempt>): LayerMarks {
  const byLayer = new Map(marks.byLayer);
  const ids = new Set(marks.ids);
  for (const attempt of attempts) {
    if (ids.has(attempt.id)) continue;
    ids.add(attempt.id);
    byLayer.set(attempt.layer, markWith(byLayer.get(attempt.layer) ?? unmarked, attempt.verdict));
  }
  return ids.size === marks.ids.size ? marks : { byLayer, ids };
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
