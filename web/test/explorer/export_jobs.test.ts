// @vitest-environment happy-dom
import { afterEach, describe, expect, it, vi } from "vitest";

import { takeEvent } from "../../src/api/live";
import type { ExportJob } from "../../src/api/types";
import { ExportJobs } from "../../src/explorer/export_jobs";

const job = (state: ExportJob["state"], done: number): ExportJob => ({
  id: "a",
  kind: "section",
  state,
  done,
  total: 9,
  unit: "rows",
  seconds_left: null,
  sentence: "",
  created_at: "2026-11-22T03:04:05Z",
  command: "",
  files: [],
});
const tell = (told: ExportJob) => takeEvent({ name: "export", data: JSON.stringify(told), id: "" });
const order = {
  kind: "section",
  format: "png",
  parameters: {},
  movie: false,
  frames: false,
} as const;

describe("exports", () => {
  afterEach(() => {
    vi.unstubAllGlobals();
  });

  it("do not go back when the answer comes after the events", async () => {
    const exports = new ExportJobs();
    const stop = exports.watch();
    vi.stubGlobal("fetch", async () => {
      tell(job("running", 4));
      tell(job("done", 9));
      return new Response(JSON.stringify(job("queued", 0)), { status: 202 });
    });
    await exports.order(order);
    expect(exports.jobs.value.map(({ state }) => state)).toEqual(["done"]);

    vi.stubGlobal(
      "fetch",
      async () => new Response(JSON.stringify({ exports: [job("running", 5)] })),
    );
    await exports.learn();
    expect(exports.jobs.value.map(({ state }) => state)).toEqual(["done"]);
    stop();
  });

  it("are not overwritten by an answer that was given before they were ordered or removed", async () => {
    const exports = new ExportJobs();
    const stop = exports.watch();
    const old = { ...job("done", 9), id: "old" };
    tell(old);
    let answer = (_: Response) => {};
    vi.stubGlobal("fetch", async (_: string, { method }: RequestInit) => {
      if (method === "DELETE") return new Response(null, { status: 204 });
      if (method === "POST") return new Response(JSON.stringify(job("queued", 0)));
      return new Promise<Response>((resolve) => (answer = resolve));
    });
    const learnt = exports.learn();
    await exports.order(order);
    await exports.remove(old);
    answer(new Response(JSON.stringify({ exports: [old] })));
    await learnt;
    expect(exports.jobs.value.map(({ id }) => id)).toEqual(["a"]);
    stop();
  });

  it("are ordered once, however often that is pressed", async () => {
    const exports = new ExportJobs();
    let answer = (_: Response) => {};
    const fetched = vi.fn(() => new Promise<Response>((resolve) => (answer = resolve)));
    vi.stubGlobal("fetch", fetched);
    const ordered = [exports.order(order), exports.order(order)];
    expect(exports.ordering.value).toBe(true);
    answer(new Response(JSON.stringify(job("queued", 0))));
    await Promise.all(ordered);
    expect(fetched).toHaveBeenCalledTimes(1);
    expect(exports.ordering.value).toBe(false);
    vi.stubGlobal("fetch", () => Promise.reject(new TypeError("no network")));
    await exports.order(order);
    expect(exports.ordering.value).toBe(false);
  });

  it("are written to the disk as they come, where the browser lets the page", async () => {
    const exports = new ExportJobs();
    let written = "";
    const file = new WritableStream<Uint8Array>({
      write: (piece) => void (written += new TextDecoder().decode(piece)),
    });
    const pick = vi.fn(async () => ({ createWritable: async () => file }));
    vi.stubGlobal("showSaveFilePicker", pick);
    vi.stubGlobal("fetch", async () => new Response("a picture"));
    await exports.download("/api/v1/exports/a/files/section.png", "section.png");
    expect(written).toBe("a picture");
    expect(pick).toHaveBeenCalledWith({ suggestedName: "section.png" });

    pick.mockRejectedValueOnce(new DOMException("no file was chosen", "AbortError"));
    await exports.download("/api/v1/exports/a/files/section.png", "section.png");
    expect(exports.failure.value).toBe("");
    expect(exports.downloads.value.size).toBe(0);
  });

  it("go on with each event", () => {
    const exports = new ExportJobs();
    const stop = exports.watch();
    tell(job("queued", 0));
    tell(job("running", 2));
    expect(exports.jobs.value[0].done).toBe(2);
    tell(job("cancelled", 2));
    expect(exports.jobs.value[0].state).toBe("cancelled");
    stop();
  });

  it("are told of when they end, until somebody has seen it", () => {
    const exports = new ExportJobs();
    const stop = exports.watch();
    tell(job("done", 9)); // it had ended before
    expect(exports.news.value).toBeNull();
    tell({ ...job("running", 4), id: "b" });
    expect(exports.underWay.value?.id).toBe("b");
    tell({ ...job("done", 9), id: "b" });
    expect(exports.underWay.value).toBeUndefined();
    expect(exports.news.value?.id).toBe("b");
    exports.news.value = null;
    tell({ ...job("running", 4), id: "c" });
    tell({ ...job("cancelled", 4), id: "c" });
    expect(exports.news.value).toBeNull();
    stop();
  });
});
