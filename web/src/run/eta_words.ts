import { durationWords } from "../shell/duration_words";

/** How long the job still takes, as far as is known. */
export interface TimeLeft {
  /** "about 3 h 20 min"; null when nothing is known. */
  words: string | null;
  /** "3 h to 3 h 50 min"; null when the range says nothing that the words don't. */
  range: string | null;
  /** "02:40", "tomorrow 02:40", "Fri 3 May, 02:40" */
  end: string | null;
}

/** `now` in milliseconds, `locale` as Intl takes it. */
export function timeLeft(
  seconds: number | null,
  range: [number, number] | null,
  now: number,
  locale?: string,
): TimeLeft {
  if (seconds === null || !Number.isFinite(seconds)) return { words: null, range: null, end: null };
  return {
    words: `about ${durationWords(seconds)}`,
    range: rangeWords(range),
    end: clockWords(now + seconds * 1000, now, locale),
  };
}

function rangeWords(range: [number, number] | null): string | null {
  if (!range) return null;
  const [low, high] = range.map(durationWords);
  return low === high ? null : `${low} to ${high}`;
}

/** A moment on the clock on the wall, with the day where it is not today. */
export function clockWords(moment: number, now: number, locale?: string): string {
  const at = new Date(moment);
  const clock = at.toLocaleTimeString(locale, {
    hour: "2-digit",
    minute: "2-digit",
    hourCycle: "h23",
  });
  const days = daysBetween(new Date(now), at);
  if (days === 0) return clock;
  if (days === 1) return `tomorrow, ${clock}`;
  const day = at.toLocaleDateString(locale, { weekday: "short", day: "numeric", month: "short" });
  return `${day}, ${clock}`;
}

/** Midnights between two moments, by this computer's clock; a day may have 23 or 25 hours. */
function daysBetween(from: Date, to: Date): number {
  const midnight = (date: Date) =>
    new Date(date.getFullYear(), date.getMonth(), date.getDate()).getTime();
  return Math.round((midnight(to) - midnight(from)) / 86_400_000);
}
