import { describe, expect, it } from "vitest";

import type { Attempt, History } from "../../src/api/types";
import { isRejected } from "../../src/journal/verdict_words";
import { AttemptHistory } from "../../src/run/attempt_history";
import { chartData, firstRowFrom, lastOf } from "../../src/run/chart_data";

function anAttempt(id: number, layer: number, changes: Partial<Attempt> = {}): Attempt {
  return {
    id,
    layer,
    attempt: 1,
    taken_at: "2024-05-01T10:00:00Z",
    verdict: "accepted",
    slug: "",
    reason: "",
    metrics: [{ name: "sharpness", value: 1 + id / 100, limit: 0.96, passed: true }],
    column_um: 600 + layer,
    file: null,
    ...changes,
  };
}

const blurred = { verdict: "rejected", slug: "blurred", reason: "it is blurred" };

function fetched(...attempts: Attempt[]): History {
  return {
    last: attempts.at(-1)?.id ?? 0,
    id: attempts.map((one) => one.id),
    layer: attempts.map((one) => one.layer),
    attempt: attempts.map((one) => one.attempt),
    verdict: attempts.map((one) => one.verdict),
    column_um: attempts.map((one) => one.column_um),
    taken_at: attempts.map((one) => one.taken_at),
    metrics: {
      sharpness: {
        value: attempts.map((one) => one.metrics[0]?.value ?? null),
        limit: attempts.map((one) => one.metrics[0]?.limit ?? null),
      },
    },
  };
}

describe("AttemptHistory", () => {
  it("is the same whether it was fetched or heard", () => {
    const all = [anAttempt(1, 1), anAttempt(2, 2, blurred), anAttempt(3, 2, { attempt: 2 })];
    const loaded = new AttemptHistory(["sharpness"]);
    loaded.load(fetched(...all));
    const heard = new AttemptHistory(["sharpness"]);
    for (const one of all) expect(heard.append(one)).toBe(true);
    expect(loaded.layer).toEqual([1, 2, 2]);
    expect(loaded.attempt).toEqual([1, 1, 2]);
    expect(loaded.rejected).toEqual([false, true, false]);
    expect(loaded.column("sharpness")).toEqual({
      value: [1.01, 1.02, 1.03],
      limit: [0.96, 0.96, 0.96],
    });
    expect(loaded.column("column_um").value).toEqual([601, 602, 602]);
    expect(heard.layer).toEqual(loaded.layer);
    expect(heard.attempt).toEqual(loaded.attempt);
    expect(heard.rejected).toEqual(loaded.rejected);
    expect([...heard.columns]).toEqual([...loaded.columns]);
    expect(heard.rejectedCount).toBe(1);
    expect(heard.last).toBe(3);
  });

  it("takes each attempt once", () => {
    const history = new AttemptHistory(["sharpness"]);
    history.load(fetched(anAttempt(1, 1), anAttempt(2, 2)));
    expect(history.append(anAttempt(2, 2))).toBe(false);
    history.load(fetched(anAttempt(1, 1), anAttempt(2, 2), anAttempt(3, 3)));
    expect(history.layer).toEqual([1, 2, 3]);
  });

  it("leaves a gap where a metric was not measured", () => {
    const history = new AttemptHistory(["sharpness", "other"]);
    history.append(anAttempt(1, 1, { metrics: [], column_um: null }));
    history.load(fetched(anAttempt(2, 2)));
    expect(history.column("sharpness").value).toEqual([null, 1.02]);
    expect(history.column("other").value).toEqual([null, null]);
    expect(history.column("column_um").value).toEqual([null, 602]);
  });

  it("counts a frame that could not be stored among the rejected", () => {
    expect(isRejected("not_stored")).toBe(true);
    expect(isRejected("accepted_with_flag")).toBe(false);
  });
});

describe("chartData", () => {
  const history = new AttemptHistory(["sharpness"]);
  history.load(fetched(anAttempt(1, 1), anAttempt(2, 2, blurred), anAttempt(3, 2)));

  it("parts accepted from rejected, and has a limit on the sides where it counts", () => {
    expect(chartData(history, "sharpness", "none")).toEqual([
      [1, 2, 2],
      [1.01, null, 1.03],
      [null, 1.02, null],
    ]);
    expect(chartData(history, "sharpness", "least")[3]).toEqual([0.96, 0.96, 0.96]);
    expect(chartData(history, "sharpness", "within")[4]).toEqual([-0.96, -0.96, -0.96]);
  });

  it("does not change when the history grows", () => {
    const data = chartData(history, "column_um", "none");
    const before = JSON.stringify(data);
    history.append(anAttempt(4, 3));
    expect(JSON.stringify(data)).toBe(before);
  });

  it("holds ten thousand layers", () => {
    const large = new AttemptHistory(["sharpness"]);
    for (let id = 1; id <= 10_000; id += 1) large.append(anAttempt(id, id));
    expect(chartData(large, "sharpness", "least")[0]).toHaveLength(10_000);
    expect(large.length).toBe(10_000);
  });
});

describe("firstRowFrom", () => {
  it("finds the first of equals", () => {
    expect(firstRowFrom([1, 2, 2, 2, 5], 2)).toBe(1);
    expect(firstRowFrom([1, 2, 2, 2, 5], 3)).toBe(4);
    expect(firstRowFrom([1, 2], 9)).toBe(2);
    expect(firstRowFrom([], 1)).toBe(0);
  });
});

describe("lastOf", () => {
  it("skips what is missing", () => {
    expect(lastOf([1, 2, null])).toBe(2);
    expect(lastOf([null])).toBeNull();
    expect(lastOf([])).toBeNull();
  });
});
