// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { SeenTab, type TabChannel } from "../../src/api/seen_tab";

const settle = () => vi.advanceTimersByTimeAsync(1);

describe("what is known at present", () => {
  let live: typeof import("../../src/api/live");
  let channel: TabChannel;
  let tab: SeenTab;
  let streams: { lastId: string | null; ended: boolean }[];
  let write: (text: string) => void;
  let answers: "well" | "not at all";
  let services: number;
  let busy: boolean;

  const fetch = async (path: RequestInfo | URL, init?: RequestInit): Promise<Response> => {
    if (String(path).endsWith("/service")) {
      services += 1;
      if (busy) return new Response("{}", { status: 503 });
      return new Response(JSON.stringify({ version: "1", kind: "rig", sample: "knee" }));
    }
    const stream = { lastId: new Headers(init?.headers).get("Last-Event-ID"), ended: false };
    streams.push(stream);
    const given = init?.signal;
    if (answers === "not at all") {
      return new Promise((_, reject) =>
        given?.addEventListener("abort", () => reject(new DOMException("", "AbortError"))),
      );
    }
    const body = new ReadableStream<Uint8Array>({
      start(controller) {
        write = (text) => controller.enqueue(new TextEncoder().encode(text));
        given?.addEventListener("abort", () => {
          stream.ended = true;
          controller.error(new DOMException("given up", "AbortError"));
        });
      },
    });
    return new Response(body);
  };

  beforeEach(async () => {
    vi.useFakeTimers();
    vi.resetModules(); // it lives as long as the page
    streams = [];
    services = 0;
    busy = false;
    answers = "well";
    vi.stubGlobal("fetch", fetch);
    channel = { onmessage: null, postMessage: () => undefined };
    tab = new SeenTab(channel);
    tab.show(true);
    live = await import("../../src/api/live");
    live.goLive(tab);
    await settle();
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("is asked for again where the server was too busy to say what it is", async () => {
    busy = true;
    hideBehindAnother();
    tab.show(true);
    await settle();
    expect(live.connection.value.state).toBe("live");
    const before = services;
    busy = false;
    await vi.advanceTimersByTimeAsync(10_000);
    expect(services).toBe(before + 1);
  });

  const hideBehindAnother = () => {
    tab.show(false);
    const claim = { at_ms: Date.now() + 1, tab: 0 };
    channel.onmessage?.({ data: { claim, isOver: false, isSeen: true } });
  };

  it("is not listened for by a tab that nobody sees, and no loss is told of", async () => {
    expect(live.connection.value.state).toBe("live");
    hideBehindAnother();
    await vi.advanceTimersByTimeAsync(60_000);
    expect(streams.map(({ ended }) => ended)).toEqual([true]);
    expect(live.connection.value.state).toBe("resting");
  });

  it("is caught up with at once by one that is seen again", async () => {
    write('id: 7\nevent: attempt\ndata: {"id":7}\n\n');
    await settle();
    hideBehindAnother();
    await settle();
    tab.show(true);
    await settle();
    expect(streams.map(({ lastId }) => lastId)).toEqual([null, "7"]);
    expect(live.connection.value.state).toBe("live");
    expect(services).toBe(2); // it may be another server by now
  });

  it("is caught up with from where it was loaded anew", async () => {
    write('id: 7\nevent: attempt\ndata: {"id":7}\n\n');
    write("id: 9\nevent: reload\ndata: {}\n\n");
    write('event: status\ndata: {"state":"grinding"}\n\n');
    await settle();
    hideBehindAnother();
    await settle();
    tab.show(true);
    await settle();
    expect(streams.map(({ lastId }) => lastId)).toEqual([null, "9"]);
  });

  it("is of one sample: another of the same name loads the page anew", async () => {
    const reload = vi.spyOn(location, "reload").mockImplementation(() => undefined);
    const tell = async (created: string | null, committed: number) => {
      const progress = { committed, layers_present: committed, created, generation: 1 };
      write(`event: sample\ndata: ${JSON.stringify(progress)}\n\n`);
      await settle();
    };
    await tell(null, 0);
    await tell("2026-11-01T18:00:00Z", 1);
    await tell("2026-11-01T18:00:00Z", 2);
    await tell(null, 0); // it was taken away
    expect(reload).not.toHaveBeenCalled();
    await tell("2026-11-02T18:00:00Z", 1);
    expect(reload).toHaveBeenCalledTimes(1);
    reload.mockRestore();
  });

  it("is told to be old when one looks again and the server is silent", async () => {
    hideBehindAnother();
    await settle();
    answers = "not at all";
    tab.show(true);
    await vi.advanceTimersByTimeAsync(900);
    expect(live.connection.value.state).toBe("resting");
    await vi.advanceTimersByTimeAsync(200);
    expect(live.connection.value.state).toBe("lost");
  });

  it("is heard every few seconds, and is no less known, where other windows are seen too", async () => {
    write('id: 7\nevent: attempt\ndata: {"id":7}\n\n');
    await settle();
    for (let other = 1; other <= 4; other += 1) {
      const claim = { at_ms: Date.now() + other, tab: other };
      channel.onmessage?.({ data: { claim, isOver: false, isSeen: true } });
    }
    await settle();
    expect(streams.map(({ ended }) => ended)).toEqual([true]);
    expect(live.connection.value.state).toBe("live");
    for (let ms = 0; ms < 5100 && streams.length < 2; ms += 100) {
      await vi.advanceTimersByTimeAsync(100);
    }
    expect(streams.map(({ lastId }) => lastId)).toEqual([null, "7"]);
    write('event: status\ndata: {"state":"grinding"}\n\n');
    await settle();
    expect(live.status.value?.state).toBe("grinding");
    await vi.advanceTimersByTimeAsync(20_000);
    expect(streams.length).toBeGreaterThan(3);
    expect(streams.slice(0, -1).every(({ ended }) => ended)).toBe(true);
    tab.show(true);
    await vi.advanceTimersByTimeAsync(60_000);
    expect(streams.at(-1)?.ended).toBe(false);
    expect(live.connection.value.state).toBe("live");
  });

  it("goes on being heard by the tab that was seen last, so that an alarm sounds", async () => {
    tab.show(false);
    await settle();
    write('event: status\ndata: {"state":"faulted"}\n\n');
    await settle();
    expect(live.status.value?.state).toBe("faulted");
    expect(live.connection.value.state).toBe("live");
  });
});
