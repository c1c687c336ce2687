// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { aStatus, anAlarm as alarm } from "../a_status";

describe("the sound of an alarm", () => {
  let live: typeof import("../../src/api/live");
  let sound: typeof import("../../src/shell/alarm_sound");
  let tones: number;

  /** Plays nothing, and counts. */
  class SilentContext {
    state = "running";
    currentTime = 0;
    destination = {};
    resume = async () => undefined;
    createOscillator = () => ({
      frequency: {},
      connect: (next: unknown) => next,
      start: () => (tones += 1),
      stop: () => undefined,
    });
    createGain = () => ({
      gain: { setValueAtTime: () => undefined, linearRampToValueAtTime: () => undefined },
      connect: (next: unknown) => next,
    });
  }

  beforeEach(async () => {
    vi.useFakeTimers();
    vi.resetModules(); // it lives as long as the page
    localStorage.clear();
    vi.stubGlobal("AudioContext", SilentContext);
    tones = 0;
    live = await import("../../src/api/live");
    sound = await import("../../src/shell/alarm_sound");
    sound.watchAlarms();
    live.status.value = aStatus({ alarm: alarm });
  });
  afterEach(() => {
    live.status.value = null;
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  const tonesIn = async (ms: number) => {
    await vi.advanceTimersByTimeAsync(100); // what had begun is heard to its end
    const before = tones;
    await vi.advanceTimersByTimeAsync(ms);
    return tones - before;
  };
  const isIn = (state: typeof live.connection.value.state) => {
    live.connection.value = { ...live.connection.value, state };
  };

  it("is heard where it was asked for, until it is silenced", async () => {
    expect(await tonesIn(10_000)).toBe(0);
    sound.wantSound(true);
    expect(await tonesIn(10_000)).toBeGreaterThan(5);
    sound.silence();
    expect(await tonesIn(10_000)).toBe(0);
  });

  it("is not gone on with by a tab that no longer hears whether it is over", async () => {
    sound.wantSound(true);
    isIn("lost");
    expect(await tonesIn(10_000)).toBeGreaterThan(5);
    isIn("resting");
    expect(await tonesIn(10_000)).toBe(0);
  });

  it("is switched in all tabs of the browser", async () => {
    localStorage.setItem("biotomy-sound", "on");
    window.dispatchEvent(new StorageEvent("storage", { key: "biotomy-sound" }));
    expect(await tonesIn(10_000)).toBeGreaterThan(5);
    localStorage.setItem("biotomy-sound", "off");
    window.dispatchEvent(new StorageEvent("storage", { key: "biotomy-sound" }));
    expect(await tonesIn(10_000)).toBe(0);
  });
});
