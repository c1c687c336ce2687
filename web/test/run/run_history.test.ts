// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import type { Attempt } from "../../src/api/types";

const settle = () => vi.advanceTimersByTimeAsync(1);

function anAttempt(id: number, verdict = "accepted"): Attempt {
  return {
    id,
    layer: id,
    attempt: 1,
    taken_at: "",
    verdict,
    slug: verdict === "rejected" ? "blurred" : "",
    reason: "",
    metrics: [],
    column_um: id,
    file: null,
  };
}

/** A journal that answers as the server does. */
class FakeJournal {
  attempts: Attempt[] = [];
  asked: string[] = [];
  status = 200;

  fetch = async (path: RequestInfo | URL): Promise<Response> => {
    const url = new URL(String(path), "http://rig");
    this.asked.push(url.pathname);
    if (this.status !== 200) return new Response("{}", { status: this.status });
    if (url.pathname === "/api/v1/rejected") {
      const rejected = this.attempts.filter(({ verdict }) => verdict === "rejected").reverse();
      return new Response(JSON.stringify({ count: rejected.length, rejected }));
    }
    const after = Number(url.searchParams.get("after"));
    const rows = this.attempts.filter(({ id }) => id > after);
    return new Response(
      JSON.stringify({
        last: rows.at(-1)?.id ?? after,
        id: rows.map(({ id }) => id),
        layer: rows.map(({ layer }) => layer),
        attempt: rows.map(({ attempt }) => attempt),
        verdict: rows.map(({ verdict }) => verdict),
        column_um: rows.map(({ column_um }) => column_um),
        taken_at: rows.map(({ taken_at }) => taken_at),
        metrics: {},
      }),
    );
  };
}

describe("the run's history", () => {
  let journal: FakeJournal;
  let live: typeof import("../../src/api/live");
  let run: typeof import("../../src/run/run_history");

  const tell = (name: string, data: unknown, id = "") =>
    live.takeEvent({ name, data: JSON.stringify(data), id });
  const make = (attempt: Attempt) => {
    journal.attempts.push(attempt);
    tell("attempt", attempt, String(attempt.id));
  };

  beforeEach(async () => {
    vi.useFakeTimers();
    vi.resetModules(); // it lives as long as the page
    journal = new FakeJournal();
    vi.stubGlobal("fetch", journal.fetch);
    live = await import("../../src/api/live");
    run = await import("../../src/run/run_history");
    run.collectHistory();
  });

  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("asks for nothing before there is something", async () => {
    tell("sample", { committed: 0, layers_present: 0, generation: 1 });
    await settle();
    expect(journal.asked).toEqual([]);
    tell("sample", { committed: 1, layers_present: 1, generation: 2 });
    await settle();
    expect(journal.asked).toEqual(["/api/v1/history", "/api/v1/rejected"]);
  });

  it("has each attempt once and in order, whether fetched or heard", async () => {
    journal.attempts = [anAttempt(1), anAttempt(2, "rejected")];
    make(anAttempt(3)); // heard first, and fetched with the others
    make(anAttempt(4)); // heard while it is fetched
    await settle();
    make(anAttempt(5, "rejected"));
    expect(run.history.layer).toEqual([1, 2, 3, 4, 5]);
    expect(run.rejectedCount.value).toBe(2);
    expect(run.rejectedOfLate.value.map(({ id }) => id)).toEqual([5, 2]);
    expect(journal.asked).toHaveLength(2);
  });

  it("lists the last rejected ones, the newest first and no more than twenty", async () => {
    make(anAttempt(1));
    await settle();
    for (let id = 2; id <= 30; id += 1) make(anAttempt(id, "rejected"));
    expect(run.rejectedOfLate.value).toHaveLength(20);
    expect(run.rejectedOfLate.value[0]).toMatchObject({ id: 30, slug: "blurred" });
    expect(run.rejectedCount.value).toBe(29);
  });

  it("tells the charts of many attempts at once", async () => {
    make(anAttempt(1));
    await vi.advanceTimersByTimeAsync(300);
    const before = run.historyVersion.value;
    for (let id = 2; id < 50; id += 1) make(anAttempt(id));
    await vi.advanceTimersByTimeAsync(300);
    expect(run.historyVersion.value).toBe(before + 1);
  });

  it("fetches what was missed when the stream has a gap", async () => {
    make(anAttempt(1));
    await settle();
    journal.attempts.push(anAttempt(2), anAttempt(3));
    tell("reload", {});
    make(anAttempt(4));
    await settle();
    expect(run.history.layer).toEqual([1, 2, 3, 4]);
  });

  it("asks again when one answer was lost though the stream goes on", async () => {
    live.connection.value = { ...live.connection.value, state: "live" };
    journal.attempts = [anAttempt(1)];
    vi.stubGlobal("fetch", () => Promise.reject(new TypeError("the connection was reset")));
    make(anAttempt(2));
    await settle();
    vi.stubGlobal("fetch", journal.fetch);
    await vi.advanceTimersByTimeAsync(10_000);
    expect(run.history.layer).toEqual([1, 2]);
  });

  it("asks again when the server would not answer, and loses nothing", async () => {
    journal.attempts = [anAttempt(1)];
    journal.status = 503;
    make(anAttempt(2));
    await settle();
    expect(run.history.length).toBe(0);
    make(anAttempt(3));
    journal.status = 200;
    await vi.advanceTimersByTimeAsync(10_000);
    expect(run.history.layer).toEqual([1, 2, 3]);
  });
});
