import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { rest_ms, SectionLoader } from "../../src/explorer/section_loader";
import type { Wish } from "../../src/explorer/section_loader";
import type { SectionPicture } from "../../src/explorer/section_record";

const wishFor = (name: string): Wish => {
  const asked = { of: name, whole: true };
  return {
    preview: { ...asked, address: name, sharp: false },
    sharp: { ...asked, address: `sharp ${name}`, sharp: true },
  };
};

interface Asked {
  address: string;
  signal: AbortSignal;
  answer: (picture: SectionPicture) => void;
  refuse: (error: unknown) => void;
}

function bench() {
  const asked: Asked[] = [];
  const shown: string[] = [];
  const failures: unknown[] = [];
  const loader = new SectionLoader({
    fetch: ({ address, sharp }, signal) =>
      new Promise((resolve, reject) => {
        const image = { name: address, close: () => {} } as unknown as ImageBitmap;
        asked.push({
          address,
          signal,
          answer: () => resolve({ image, sharp } as SectionPicture),
          refuse: reject,
        });
        signal.addEventListener("abort", () => reject(new DOMException("", "AbortError")));
      }),
    deliver: ({ image }) => shown.push((image as unknown as { name: string }).name),
    fail: (error) => failures.push(error),
    busyWait_ms: (error) => (error === "busy" ? 1000 : null),
  });
  const answerLast = async () => {
    asked[asked.length - 1].answer({} as SectionPicture);
    await vi.advanceTimersByTimeAsync(60);
  };
  return { asked, shown, failures, loader, answerLast };
}

beforeEach(() => void vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout", "performance"] }));
afterEach(() => void vi.useRealTimers());

describe("pictures of a plane that moves", () => {
  it("come one at a time, the newest wish next", async () => {
    const { asked, shown, loader, answerLast } = bench();
    for (const name of ["a", "b", "c"]) loader.wish(wishFor(name));
    expect(asked.map(({ address }) => address)).toEqual(["a"]);
    await answerLast();
    expect(asked.map(({ address }) => address)).toEqual(["a", "c"]);
    await answerLast();
    expect(shown).toEqual(["a", "c"]);
  });

  it("are sharpened when the hand rests", async () => {
    const { asked, shown, loader, answerLast } = bench();
    loader.wish(wishFor("a"));
    await answerLast();
    expect(asked.length).toBe(1);
    await vi.advanceTimersByTimeAsync(rest_ms);
    expect(asked[1].address).toBe("sharp a");
    await answerLast();
    expect(shown).toEqual(["a", "sharp a"]);
  });

  it("are given up when sharpening is overtaken", async () => {
    const { asked, loader, answerLast } = bench();
    loader.wish(wishFor("a"));
    await answerLast();
    await vi.advanceTimersByTimeAsync(rest_ms);
    loader.wish(wishFor("b"));
    expect(asked[1].signal.aborted).toBe(true);
    await vi.advanceTimersByTimeAsync(60);
    expect(asked[2].address).toBe("b");
  });

  it("are asked for again after the time that a busy server names", async () => {
    const { asked, shown, failures, loader, answerLast } = bench();
    loader.wish(wishFor("a"));
    asked[0].refuse("busy");
    await vi.advanceTimersByTimeAsync(500);
    expect(asked.length).toBe(1);
    await vi.advanceTimersByTimeAsync(600);
    expect(asked[1].address).toBe("a");
    await answerLast();
    expect(shown).toEqual(["a"]);
    expect(failures).toEqual([]);
  });

  it("are not asked for twice where the answer is no", async () => {
    const { asked, failures, loader } = bench();
    loader.wish(wishFor("a"));
    asked[0].refuse("it misses the block");
    await vi.advanceTimersByTimeAsync(1000);
    expect(asked.length).toBe(1);
    expect(failures).toEqual(["it misses the block"]);
  });

  it("stop when nobody looks", async () => {
    const { asked, loader } = bench();
    loader.wish(wishFor("a"));
    loader.stop();
    expect(asked[0].signal.aborted).toBe(true);
    await vi.advanceTimersByTimeAsync(1000);
    expect(asked.length).toBe(1);
  });
});
