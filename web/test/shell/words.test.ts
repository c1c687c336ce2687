// @vitest-environment happy-dom
import { describe, expect, it } from "vitest";

import type { Status } from "../../src/api/types";
import { alarmKey } from "../../src/shell/alarm_sound";
import { durationWords } from "../../src/shell/duration_words";
import { hashOf, parseHash } from "../../src/shell/route";
import { sampleName } from "../../src/shell/sample_name";
import { stateSentence, stateWords, wordsOf } from "../../src/shell/state_words";
import { tabTitle } from "../../src/shell/tab_sign";
import { aStatus, anAlarm as alarm } from "../a_status";

describe("durationWords", () => {
  it.each([
    [0, "0 s"],
    [89.4, "89 s"],
    [90, "2 min"],
    [150, "3 min"],
    [3569, "59 min"],
    [3599, "1 h"],
    [3600 * 3 + 60 * 20, "3 h 20 min"],
    [86_400, "1 day"],
    [86_400 * 2 + 3600 * 4, "2 days 4 h"],
    [-5, "0 s"],
    [Number.NaN, "–"],
  ])("%d seconds are %s", (seconds, words) => {
    expect(durationWords(seconds)).toBe(words);
  });
});

describe("the state in words", () => {
  it("is a sentence for each state", () => {
    for (const words of Object.values(stateWords)) {
      expect(words.sentence).toMatch(/^[A-Z].*\.$/);
      expect(words.short).toMatch(/^[A-Z]/);
    }
  });

  it("is something for a state that this page does not know", () => {
    expect(wordsOf("dancing" as Status["state"]).sentence).toBe("The job is dancing.");
  });

  it("tells of a pause that was asked for", () => {
    const grinding = aStatus({ state: "grinding", pause_requested: true });
    expect(stateSentence(grinding)).toMatch(/It pauses when this step is done\.$/);
    const paused = aStatus({ state: "paused", pause_requested: true });
    expect(stateSentence(paused)).not.toMatch(/It pauses/);
  });

  it("does not take for the start what comes after it", () => {
    const stuck = { ...alarm, state: "faulted", kind: "controller" } as const;
    expect(stateSentence(aStatus({ state: "faulted", alarm: stuck }))).toContain("has stopped");
    expect(alarmKey(aStatus({ alarm: stuck }))).not.toBe("");
    const start = { ...stuck, kind: "start_latch" } as const;
    expect(alarmKey(aStatus({ alarm: start }))).toBe("");
  });

  it("does not call the start an accident", () => {
    const latch = { ...alarm, state: "faulted", kind: "start_latch" } as const;
    const started = aStatus({ state: "faulted", alarm: latch });
    const stopped = aStatus({ state: "faulted", alarm });
    expect(stateSentence(started)).toContain("has just started");
    expect(stateSentence(stopped)).toContain("has stopped");
  });

  it("tells where a job goes on that was broken off", () => {
    const latch = { ...alarm, state: "faulted", kind: "start_latch" } as const;
    const broken = { committed: 51, layers: 80 };
    const sentence = (changes: Partial<Status>) => stateSentence(aStatus(changes));
    const end = / Start goes on behind layer 51\.$/;
    expect(sentence({ ...broken, state: "faulted", alarm: latch })).toMatch(end);
    expect(sentence({ ...broken, state: "idle" })).toMatch(end);
    expect(sentence({ ...broken, state: "aborted" })).toMatch(end);
    expect(sentence({ ...broken, state: "faulted", alarm })).not.toMatch(end);
    expect(sentence({ state: "idle", committed: 0 })).not.toMatch(/Start/);
    expect(sentence({ state: "aborted", committed: 80, layers: 80 })).not.toMatch(/Start/);
  });
});

describe("the tab's title", () => {
  it("says what matters most first", () => {
    const status = aStatus({ state: "grinding", committed: 12, layers: 80, sample: "/data/knee" });
    expect(tabTitle(status, null, "live")).toBe("Grinding 12/80 – knee – Biotomy");
    expect(tabTitle(status, null, "lost")).toBe("Connection lost – knee – Biotomy");
    const alarmed = { ...status, state: "faulted", alarm } as Status;
    expect(tabTitle(alarmed, null, "lost")).toBe("⚠ ALARM – knee – Biotomy");
    expect(tabTitle(alarmed, null, "resting")).toBe("⚠ ALARM – knee – Biotomy");
    expect(tabTitle(status, null, "resting")).toBe("knee – Biotomy");
    expect(tabTitle(null, null, "connecting")).toBe("Biotomy");
  });
});

describe("alarmKey", () => {
  it("tells alarms apart, and is empty for the latch of the start", () => {
    expect(alarmKey(aStatus({ alarm }))).not.toBe("");
    expect(alarmKey(aStatus({ alarm }))).not.toBe(
      alarmKey(aStatus({ alarm: { ...alarm, since: "later" } })),
    );
    expect(alarmKey(aStatus({ alarm: { ...alarm, kind: "start_latch" } }))).toBe("");
    expect(alarmKey(aStatus({}))).toBe("");
    expect(alarmKey(null)).toBe("");
  });
});

describe("sampleName", () => {
  it("is the last part of a folder", () => {
    expect(sampleName(aStatus({ sample: "/data/samples/knee-042/" }), null)).toBe("knee-042");
    expect(sampleName(null, null)).toBe("");
  });
});

describe("parseHash", () => {
  it("reads what hashOf writes", () => {
    const query = new URLSearchParams({ points: "0,0,0 1,0,0 0,0,1" });
    const route = parseHash(hashOf(["layers", 12, "a/b"], query));
    expect(route.path).toEqual(["layers", "12", "a/b"]);
    expect(route.query.get("points")).toBe("0,0,0 1,0,0 0,0,1");
  });

  it("takes what people type", () => {
    expect(parseHash("").path).toEqual([]);
    expect(parseHash("#run").path).toEqual(["run"]);
    expect(parseHash("#/layers/100%").path).toEqual(["layers", "100%"]);
  });
});
