// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import type { StreamEvent } from "../../src/api/event_parser";
import { EventStream, backOff_ms, silenceLimit_ms } from "../../src/api/events";
import { setToken, token, tokenQuestion } from "../../src/api/token";

/** A server that answers each request with a stream that the test writes to. */
class FakeServer {
  requests: Headers[] = [];
  status = 200;
  down = false;
  private writer: ReadableStreamDefaultController<Uint8Array> | null = null;

  fetch = async (_path: RequestInfo | URL, init?: RequestInit): Promise<Response> => {
    this.requests.push(new Headers(init?.headers));
    if (this.down) throw new TypeError("no network");
    if (this.status !== 200) {
      const error = { error: { code: "unauthorized", message: "a token is needed" } };
      return new Response(JSON.stringify(error), { status: this.status });
    }
    const body = new ReadableStream<Uint8Array>({
      start: (controller) => {
        this.writer = controller;
        init?.signal?.addEventListener("abort", () => {
          try {
            controller.error(new DOMException("given up", "AbortError"));
          } catch {
            // It had ended before.
          }
        });
      },
    });
    return new Response(body, { status: 200 });
  };

  write(text: string): void {
    this.writer?.enqueue(new TextEncoder().encode(text));
  }

  end(): void {
    this.writer?.close();
  }
}

const settle = () => vi.advanceTimersByTimeAsync(1);

describe("EventStream", () => {
  let server: FakeServer;
  let stream: EventStream;
  let events: StreamEvent[];
  let states: string[];

  beforeEach(() => {
    vi.useFakeTimers();
    server = new FakeServer();
    vi.stubGlobal("fetch", server.fetch);
    events = [];
    states = [];
    stream = new EventStream("/api/v1/events", {
      event: (event) => events.push(event),
      live: () => states.push("live"),
      lost: (why) => states.push(`lost: ${why}`),
    });
  });

  afterEach(() => {
    stream.close();
    setToken("");
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("hands out what comes, and says that it is live", async () => {
    stream.open();
    await settle();
    server.write("event: status\ndata: {}\n\n");
    await settle();
    expect(states).toEqual(["live"]);
    expect(events).toEqual([{ name: "status", data: "{}", id: "" }]);
  });

  it("connects again when the stream ends, and tells the last event that came", async () => {
    stream.open();
    await settle();
    server.write("id: 41\nevent: attempt\ndata: {}\n\n");
    await settle();
    server.end();
    await settle();
    expect(states[1]).toMatch(/^lost: /);
    await vi.advanceTimersByTimeAsync(2000);
    expect(states[2]).toBe("live");
    expect(server.requests[0].get("Last-Event-ID")).toBeNull();
    expect(server.requests[1].get("Last-Event-ID")).toBe("41");
  });

  it("goes on from where the stream began, though nothing with an id came", async () => {
    stream.open();
    await settle();
    server.write("id: 41\n\nevent: status\ndata: {}\n\n");
    await settle();
    server.end();
    await vi.advanceTimersByTimeAsync(2000);
    expect(server.requests[1].get("Last-Event-ID")).toBe("41");
  });

  it("takes a long silence for a lost connection; a comment is no silence", async () => {
    stream.open();
    await settle();
    await vi.advanceTimersByTimeAsync(silenceLimit_ms - 1000);
    server.write(": \n");
    await vi.advanceTimersByTimeAsync(silenceLimit_ms - 1000);
    expect(states).toEqual(["live"]);
    await vi.advanceTimersByTimeAsync(1001);
    expect(states).toHaveLength(2);
    expect(states[1]).toMatch(/^lost: Nothing was heard/);
  });

  it("tries again, ever more slowly, while the server is down, and at once when hurried", async () => {
    server.down = true;
    stream.open();
    await vi.advanceTimersByTimeAsync(60_000);
    const tries = server.requests.length;
    expect(tries).toBeGreaterThan(5);
    expect(tries).toBeLessThan(20);
    server.down = false;
    stream.hurry();
    await settle();
    expect(server.requests.length).toBe(tries + 1);
    expect(states.at(-1)).toBe("live");
  });

  it("stops when it is closed", async () => {
    stream.open();
    await settle();
    stream.close();
    await vi.advanceTimersByTimeAsync(60_000);
    expect(server.requests).toHaveLength(1);
    expect(states).toEqual(["live"]);
  });

  it("opened again at once goes on after the last event, over one connection", async () => {
    stream.open();
    await settle();
    server.write("id: 41\nevent: attempt\ndata: {}\n\n");
    await settle();
    stream.close();
    stream.open();
    await settle();
    expect(states).toEqual(["live", "live"]);
    expect(server.requests[1].get("Last-Event-ID")).toBe("41");
    stream.hurry(); // it is open: there is nothing to hurry
    await vi.advanceTimersByTimeAsync(silenceLimit_ms - 1000);
    expect(server.requests).toHaveLength(2);
    expect(states).toEqual(["live", "live"]);
  });

  it("asks for a token where one is needed, and sends it in the header", async () => {
    server.status = 401;
    stream.open();
    await settle();
    // However long the person takes.
    await vi.advanceTimersByTimeAsync(5 * silenceLimit_ms);
    expect(tokenQuestion.value).not.toBeNull();
    server.status = 200;
    tokenQuestion.value?.answer("open sesame");
    await settle();
    expect(states).toEqual(["live"]);
    expect(server.requests.at(-1)?.get("Authorization")).toBe("Bearer open sesame");
    expect(token()).toBe("open sesame");
  });
});

describe("backOff_ms", () => {
  it("doubles to a limit", () => {
    expect(backOff_ms(1, 0.5)).toBe(500);
    expect(backOff_ms(2, 0.5)).toBe(1000);
    expect(backOff_ms(30, 0.5)).toBe(10_000);
  });

  it("is spread, so that many pages do not come at once", () => {
    expect(backOff_ms(1, 0)).toBeLessThan(backOff_ms(1, 1));
  });
});
