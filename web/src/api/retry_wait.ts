import { ApiError, ConnectionError } from "./client";

/** Answers that mean "not now": too many requests, a full queue, work that was given up. */
const passing = new Set([429, 502, 503, 504]);
const longestMs = 8000;

/**
 * How long to wait until asking again may help: as long as the server says, else `usualMs`, but never
 * longer than somebody would look at a page that lacks something. Nothing where it would not help.
 */
export function retryWaitMs(error: unknown, usualMs: number): number | null {
  if (error instanceof ConnectionError) return Math.min(usualMs, longestMs);
  if (!(error instanceof ApiError) || !passing.has(error.status)) return null;
  return Math.min(error.retryAfter === null ? usualMs : error.retryAfter * 1000, longestMs);
}

/**
 * What `ask` answers, asked again as long as that may help. Throws what it threw last, or the
 * AbortError of `signal`.
 */
export async function persistently<T>(
  ask: (signal: AbortSignal) => Promise<T>,
  signal: AbortSignal,
  usualMs: number,
): Promise<T> {
  for (;;) {
    try {
      return await ask(signal);
    } catch (error) {
      const wait = retryWaitMs(error, usualMs);
      if (wait === null) throw error;
      await pause(wait, signal);
    }
  }
}

function pause(ms: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const stop = () => {
      clearTimeout(timer);
      reject(new DOMException("given up while waiting", "AbortError"));
    };
    const timer = setTimeout(() => {
      signal.removeEventListener("abort", stop);
      resolve();
    }, ms);
    if (signal.aborted) stop();
    else signal.addEventListener("abort", stop, { once: true });
  });
}
