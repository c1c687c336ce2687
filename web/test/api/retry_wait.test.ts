import { expect, it } from "vitest";

import { ApiError, ConnectionError } from "../../src/api/client";
import { retryWaitMs } from "../../src/api/retry_wait";

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
