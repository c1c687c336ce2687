/** Verdicts of the journal in words, and how they are marked. */

export type VerdictMark = "good" | "flagged" | "rejected" | "lost";

export interface VerdictWords {
  readonly title: string;
  readonly mark: VerdictMark;
  /** The frame became the layer's image. */
  readonly accepted: boolean;
}

export function verdictWords(verdict: string): VerdictWords {
  switch (verdict) {
    case "accepted":
      return { title: "Accepted", mark: "good", accepted: true };
    case "accepted_with_flag":
      return { title: "Accepted with a flag", mark: "flagged", accepted: true };
    case "rejected":
      return { title: "Rejected", mark: "rejected", accepted: false };
    case "not_stored":
      return { title: "Good, but not stored", mark: "lost", accepted: false };
    default:
      return { title: verdict, mark: "lost", accepted: false };
  }
}

/** The frame was judged, and did not become the layer's image. */
export const isRejected = (verdict: string): boolean =>
  verdict === "rejected" || verdict === "not_stored";

/** The slug of a reason in words: "face-unchanged" is "face unchanged". */
export function slugWords(slug: string): string {
  return slug.replaceAll("-", " ");
}
