import { afterEach, beforeEach, expect, it, vi } from "vitest";

import { StreamTurns } from "../../src/api/stream_turns";

let done: string[];
let turns: StreamTurns;

beforeEach(() => {
  vi.useFakeTimers();
  done = [];
  const stream = {
    open: () => {
      done.push("open");
      turns.opened();
    },
    close: () => void done.push("close"),
  };
  turns = new StreamTurns(stream, () => 0.5);
});
afterEach(() => vi.useRealTimers());

it("the stream is given back at once, and opened for a moment every few seconds", () => {
  turns.begin();
  expect(done).toEqual(["close"]);
  vi.advanceTimersByTime(4000);
  expect(done).toEqual(["close", "open"]);
  vi.advanceTimersByTime(6000);
  expect(done).toEqual(["close", "open", "close", "open", "close"]);
});

it("it stays as it is from the end on, also where it was lost for a moment before", () => {
  turns.begin();
  vi.advanceTimersByTime(4500);
  turns.opened();
  turns.end();
  vi.advanceTimersByTime(60_000);
  expect(done).toEqual(["close", "open"]);
});

it("an open stream is left alone where there are no turns", () => {
  turns.opened();
  vi.advanceTimersByTime(60_000);
  expect(done).toEqual([]);
});
