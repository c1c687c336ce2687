import { describe, expect, it } from "vitest";

import type { Interlocks } from "../../src/api/types";
import { clockWords, timeLeft } from "../../src/run/eta_words";
import { interlocksOf } from "../../src/run/interlocks";
import { obstacleWords } from "../../src/run/obstacles";
import { fit, windowWords } from "../../src/run/window_words";
import { aStatus, anAlarm } from "../a_status";

const now = new Date(2024, 4, 1, 22, 30).getTime();
const hour = 3600;

describe("timeLeft", () => {
  it("says how long, between what, and when it ends", () => {
    const left = timeLeft(3 * hour, [2.5 * hour, 4 * hour], now, "en-GB");
    expect(left).toEqual({
      words: "about 3 h",
      range: "2 h 30 min to 4 h",
      end: "tomorrow, 01:30",
    });
  });

  it("says nothing where nothing is known", () => {
    expect(timeLeft(null, null, now)).toEqual({ words: null, range: null, end: null });
    expect(timeLeft(Number.NaN, null, now).words).toBeNull();
  });

  it("leaves out a range that is no range", () => {
    expect(timeLeft(100, [100, 100], now).range).toBeNull();
    expect(timeLeft(100, null, now).range).toBeNull();
  });
});

describe("clockWords", () => {
  it("names the day where it is not today", () => {
    expect(clockWords(now + 60_000, now, "en-GB")).toBe("22:31");
    expect(clockWords(now + 2 * hour * 1000, now, "en-GB")).toBe("tomorrow, 00:30");
    // The comma is up to the locale’s data.
    expect(clockWords(now + 48 * hour * 1000, now, "en-GB")).toMatch(/^Fri,? 3 May, 22:30$/);
  });
});

describe("fit and windowWords", () => {
  it("tell where a value is, and where it may be", () => {
    expect(fit(-20, [-25, -15])).toBe("good");
    expect(fit(-26, [-25, -15])).toBe("low");
    expect(fit(90, [null, 80])).toBe("high");
    expect(fit(90, null)).toBe("good");
    expect(fit(null, [0, 1])).toBe("unknown");
    expect(windowWords([-25, -15], "°C", 1)).toBe("−25 to −15\u00a0°C");
    expect(windowWords([-25.25, -15.5], "°C", 1)).toBe("−25.3 to −15.5\u00a0°C");
    expect(windowWords([null, 4.5], "mm/s", 2)).toBe("at most 4.5\u00a0mm/s");
    expect(windowWords([100, null], "rpm")).toBe("at least 100\u00a0rpm");
    expect(windowWords(null, "°C")).toBeNull();
  });
});

describe("interlocksOf", () => {
  const answering = { answers: true } as never;
  const good: Interlocks = {
    lines: { estop_pressed: false, door_open: false },
    controller: { estop_pressed: false, door_open: false, watchdog_tripped: false, homed: true },
  };
  const named = (interlocks: Interlocks, stage = answering) =>
    Object.fromEntries(
      interlocksOf(aStatus({ interlocks, stage })).map(({ name, words, good: is }) => [
        name,
        [words, is],
      ]),
    );

  it("are all good on a good rig", () => {
    const shown = named(good);
    expect(Object.values(shown).every(([, is]) => is === true)).toBe(true);
    expect(shown["E-stop"][0]).toBe("released");
  });

  it("say who saw it where line and controller disagree", () => {
    const byLine = { ...good, lines: { estop_pressed: true, door_open: false } };
    expect(named(byLine)["E-stop"]).toEqual(["pressed, by its own wire alone", false]);
    const byController = { ...good, controller: { ...good.controller!, door_open: true } };
    expect(named(byController)["Door"]).toEqual(["open, by the controller alone", false]);
  });

  it("do not call good what is not known", () => {
    const shown = named({ ...good, controller: null }, null as never);
    expect(shown["Controller"]).toEqual(["does not answer", false]);
    expect(shown["Watchdog"]).toEqual(["not known", null]);
    expect(shown["Door"]).toEqual(["closed", true]);
  });

  it("do not go by what a silent controller said before", () => {
    const shown = named(good, { answers: false } as never);
    expect(shown["Axes"]).toEqual(["not known", null]);
    const byLine = { ...good, lines: { estop_pressed: true, door_open: false } };
    expect(named(byLine, { answers: false } as never)["E-stop"]).toEqual(["pressed", false]);
  });

  it("tell of a controller that stopped the rig by itself", () => {
    const tripped = { ...good, controller: { ...good.controller!, watchdog_tripped: true } };
    expect(named(tripped)["Watchdog"]).toEqual(["has stopped the rig", false]);
    expect(named(good)["Watchdog"]).toEqual(["has not tripped", true]);
    const faulted = { answers: true, controller_state: "faulted" } as never;
    expect(named(good, faulted)["Controller"]).toEqual(["is in a fault", false]);
  });
});

describe("what stands in the way of a rig at rest", () => {
  const answering = { answers: true, controller_state: "idle" } as never;
  const lines = { estop_pressed: true, door_open: false };
  const controller = {
    estop_pressed: true,
    door_open: false,
    watchdog_tripped: true,
    homed: false,
  };
  const stopped = { stage: answering, interlocks: { lines, controller } };

  it("is said before somebody tries", () => {
    expect(obstacleWords(aStatus({ ...stopped, state: "paused" }))).toBe(
      "Before you resume: e-stop pressed; watchdog has stopped the rig.",
    );
    expect(obstacleWords(aStatus({ ...stopped, state: "idle" }))).toMatch(/^Before you start: /);
    expect(obstacleWords(aStatus({ ...stopped, state: "done" }))).toMatch(/^Before anything /);
  });

  it("is nothing on a good rig, at work, or where an alarm says it", () => {
    const good = { lines: { ...lines, estop_pressed: false }, controller: null };
    const rig = { stage: answering, interlocks: good };
    expect(obstacleWords(aStatus({ ...rig, state: "paused" }))).toBe("");
    expect(obstacleWords(aStatus({ ...stopped, state: "grinding" }))).toBe("");
    expect(obstacleWords(aStatus({ ...stopped, state: "paused", alarm: anAlarm }))).toBe("");
  });
});
