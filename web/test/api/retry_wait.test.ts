import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { ApiError, ConnectionError } from "../../src/api/client";
import { persistently, retryWaitMs } from "../../src/api/retry_wait";

const refusal = (status: number, retryAfter: number | null = null) =>
  new ApiError(status, "code", "no", retryAfter);

it.each([
  ["nobody answers", new ConnectionError(), 700],
  ["the server says when", refusal(429, 2), 2000],
  ["the server does not say when", refusal(503), 700],
  ["it would take very long", refusal(503, 3600), 8000],
  ["there is no such thing", refusal(404), null],
  ["a token is needed", refusal(401), null],
  ["it is a mistake of ours", new TypeError("oops"), null],
])("when %s", (_, error, wait) => {
  expect(retryWaitMs(error, 700)).toBe(wait);
});

describe("asking persistently", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  const settle = (ms: number) => vi.advanceTimersByTimeAsync(ms);
  const asked = (...answers: unknown[]) => {
    const ask = vi.fn<(signal: AbortSignal) => Promise<unknown>>();
    for (const answer of answers) {
      if (answer instanceof Error) ask.mockRejectedValueOnce(answer);
      else ask.mockResolvedValueOnce(answer);
    }
    return ask;
  };

  it("gives the first answer, however often it was put off", async () => {
    const ask = asked(refusal(503, 2), new ConnectionError(), "here");
    const answer = persistently(ask, new AbortController().signal, 700);
    await settle(1999);
    expect(ask).toHaveBeenCalledTimes(1);
    await settle(701);
    expect(await answer).toBe("here");
  });

  it("ends with a refusal that stands", async () => {
    const ask = asked(refusal(404), "never");
    const { signal } = new AbortController();
    await expect(persistently(ask, signal, 700)).rejects.toMatchObject({ status: 404 });
    expect(ask).toHaveBeenCalledTimes(1);
  });

  it("ends when it is given up, also between two times", async () => {
    const ended = new AbortController();
    const ask = asked(refusal(503), "never");
    const answer = persistently(ask, ended.signal, 700).catch((error: Error) => error.name);
    await settle(100);
    ended.abort();
    expect(await answer).toBe("AbortError");
    await settle(10_000);
    expect(ask).toHaveBeenCalledTimes(1);
    expect(vi.getTimerCount()).toBe(0);
  });
});
