import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { ApiError, ConnectionError } from "../../src/api/client";
import { PictureLoader } from "../../src/layers/picture_loader";

interface Asked {
  address: string;
  signal: AbortSignal;
  answer(picture: string): void;
  fail(error: Error): void;
}

function bench(kept = 3, atOnce = 2) {
  const asked: Asked[] = [];
  const disposed: string[] = [];
  const changed = vi.fn();
  const loader = new PictureLoader<string>(
    {
      fetch: (address, signal) =>
        new Promise((answer, fail) => {
          asked.push({ address, signal, answer, fail });
          signal.addEventListener("abort", () => fail(new Error("aborted")));
        }),
      dispose: (picture) => disposed.push(picture),
      changed,
    },
    { kept, atOnce },
  );
  return { asked, disposed, changed, loader, addresses: () => asked.map((each) => each.address) };
}

const settle = () => vi.advanceTimersByTimeAsync(0);
const refusal = (status: number, retryAfter: number | null = null) =>
  new ApiError(status, "code", "no", retryAfter);

beforeEach(() => vi.useFakeTimers());
afterEach(() => vi.useRealTimers());

describe("loading", () => {
  it("asks for a few at a time, the most urgent first", async () => {
    const { asked, loader, addresses } = bench();
    loader.want(["a", "b", "c"]);
    expect(addresses()).toEqual(["a", "b"]);
    asked[0]?.answer("A");
    await settle();
    expect(addresses()).toEqual(["a", "b", "c"]);
    expect(loader.picture("a")).toBe("A");
  });

  it("aborts what is no longer wanted, and asks no more for it", async () => {
    const { asked, loader, addresses } = bench();
    loader.want(["a", "b", "c"]);
    loader.want(["d"]);
    await settle();
    expect(asked.map((each) => each.signal.aborted)).toEqual([true, true, false]);
    expect(addresses()).toEqual(["a", "b", "d"]);
  });

  it("goes on with what is still wanted", () => {
    const { asked, loader, addresses } = bench();
    loader.want(["a", "b"]);
    loader.want(["b", "c"]);
    expect(addresses()).toEqual(["a", "b", "c"]);
    expect(asked[1]?.signal.aborted).toBe(false);
  });

  it("asks once for what is there", async () => {
    const { asked, loader, addresses } = bench();
    loader.want(["a"]);
    asked[0]?.answer("A");
    await settle();
    loader.want(["a"]);
    expect(addresses()).toEqual(["a"]);
  });

  it("gives back a picture that came after its request was aborted", async () => {
    const disposed: string[] = [];
    let answer = (_: string) => {};
    const loader = new PictureLoader<string>(
      {
        fetch: () => new Promise((resolve) => (answer = resolve)),
        dispose: (picture) => disposed.push(picture),
        changed: () => {},
      },
      { kept: 3, atOnce: 2 },
    );
    loader.want(["a"]);
    loader.want([]);
    answer("A");
    await settle();
    expect(disposed).toEqual(["A"]);
    expect(loader.picture("a")).toBeUndefined();
  });
});

describe("keeping", () => {
  async function fill(of: ReturnType<typeof bench>, addresses: string[]) {
    for (const address of addresses) {
      of.loader.want([address]);
      of.asked.at(-1)?.answer(address.toUpperCase());
      await settle();
    }
  }

  it("forgets the one that was not wanted for longest", async () => {
    const made = bench();
    await fill(made, ["a", "b", "c"]);
    made.loader.want(["a"]);
    await fill(made, ["d"]);
    expect(made.disposed).toEqual(["B"]);
    expect(made.loader.picture("a")).toBe("A");
  });

  it("keeps all that is wanted", async () => {
    const made = bench(1, 5);
    made.loader.want(["a", "b"]);
    made.asked.forEach((each) => each.answer(each.address));
    await settle();
    expect(made.disposed).toEqual([]);
    made.loader.want([]);
    expect(made.disposed).toEqual(["a"]);
  });

  it("gives everything back when it is closed", async () => {
    const made = bench();
    await fill(made, ["a", "b"]);
    made.loader.close();
    expect(made.disposed.sort()).toEqual(["A", "B"]);
  });
});

describe("failures", () => {
  it("are final where asking again would not help", async () => {
    const { asked, loader, addresses } = bench();
    loader.want(["a"]);
    asked[0]?.fail(refusal(404));
    await settle();
    await vi.advanceTimersByTimeAsync(60_000);
    expect(addresses()).toEqual(["a"]);
    expect(loader.failure("a")?.message).toBe("no");
  });

  it("are forgotten with what is no longer wanted", async () => {
    const { asked, loader, addresses } = bench();
    loader.want(["a"]);
    asked[0]?.fail(refusal(401));
    await settle();
    loader.want([]);
    loader.want(["a"]);
    expect(addresses()).toEqual(["a", "a"]);
    expect(loader.failure("a")).toBeUndefined();
  });

  it("are tried again when the server says when", async () => {
    const { asked, loader, addresses } = bench();
    loader.want(["a"]);
    asked[0]?.fail(refusal(429, 2));
    await vi.advanceTimersByTimeAsync(1999);
    expect(addresses()).toEqual(["a"]);
    await vi.advanceTimersByTimeAsync(1);
    expect(addresses()).toEqual(["a", "a"]);
  });

  it("are tried again at growing intervals while nobody answers", async () => {
    const { asked, loader } = bench();
    loader.want(["a"]);
    asked[0]?.fail(new ConnectionError());
    await vi.advanceTimersByTimeAsync(500);
    expect(asked).toHaveLength(2);
    asked[1]?.fail(new ConnectionError());
    await vi.advanceTimersByTimeAsync(999);
    expect(asked).toHaveLength(2);
    await vi.advanceTimersByTimeAsync(1);
    expect(asked).toHaveLength(3);
  });
});
