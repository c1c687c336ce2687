import { ApiError, ConnectionError, request } from "./client";
import { EventParser, type StreamEvent } from "./event_parser";
import { tokenQuestion } from "./token";

/** Nothing heard for so long, not even a comment: the connection is lost. */
export const silenceLimit_ms = 12_000;

const shortestWait_ms = 500;
const longestWait_ms = 10_000;

/** How long to wait before attempt `failures + 1`: doubled each time, and spread by a quarter. */
export function backOff_ms(failures: number, random = Math.random()): number {
  const wait = Math.min(longestWait_ms, shortestWait_ms * 2 ** Math.max(0, failures - 1));
  return wait * (0.75 + random / 2);
}

export interface EventListener {
  event(event: StreamEvent): void;
  /** The stream is open. */
  live(): void;
  /** It is not, or not any more; it is tried again `retry_ms` from now. */
  lost(why: string, retry_ms: number): void;
}

/**
 * The server's event stream, read by fetch() so that the token travels in a header. It is opened
 * again whenever it ends, and told the last event that came, so that nothing is missed.
 */
export class EventStream {
  /** Date.now() when something was last heard, a comment included; 0 if nothing ever was. */
  heardAt = 0;

  private lastId = "";
  private failures = 0;
  private connection: AbortController | null = null;
  private retry: number | undefined;
  private closed = true;

  constructor(
    private readonly path: string,
    private readonly listener: EventListener,
  ) {}

  /** Goes on after the last event that came, if it was open before. */
  open(): void {
    if (!this.closed) return;
    this.closed = false;
    this.failures = 0;
    void this.connect();
  }

  /** Nothing is told any more, not even that it was closed. */
  close(): void {
    this.closed = true;
    clearTimeout(this.retry);
    this.connection?.abort();
    this.connection = null;
  }

  /** Tries at once in place of when the wait is over: the network is back, or the tab is seen. */
  hurry(): void {
    if (this.closed || this.connection) return;
    clearTimeout(this.retry);
    void this.connect();
  }

  private async connect(): Promise<void> {
    const connection = new AbortController();
    this.connection = connection;
    let why = "The server ended the connection.";
    let silence: number | undefined;
    const heard = () => {
      clearTimeout(silence);
      silence = window.setTimeout(() => {
        if (tokenQuestion.value) return heard(); // it is the person who is silent
        why = "Nothing was heard from the server for a while.";
        connection.abort();
      }, silenceLimit_ms);
    };
    try {
      heard();
      const headers: Record<string, string> = { Accept: "text/event-stream" };
      if (this.lastId) headers["Last-Event-ID"] = this.lastId;
      const response = await request(this.path, { headers, signal: connection.signal });
      if (this.connection !== connection) return;
      if (!response.body) throw new ConnectionError();
      heard();
      this.heardAt = Date.now();
      this.failures = 0;
      this.listener.live();
      const parser = new EventParser(this.lastId);
      const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
      for (;;) {
        const { done, value } = await reader.read();
        if (done || this.connection !== connection) break;
        heard();
        this.heardAt = Date.now();
        for (const event of parser.push(value)) {
          this.lastId = event.id;
          this.listener.event(event);
        }
      }
    } catch (error) {
      if (error instanceof ApiError || error instanceof ConnectionError) why = error.message;
    } finally {
      clearTimeout(silence);
      connection.abort();
    }
    if (this.connection !== connection) return; // it was closed, and may be open again
    this.connection = null;
    this.failures += 1;
    const wait_ms = backOff_ms(this.failures);
    this.listener.lost(why, wait_ms);
    this.retry = window.setTimeout(() => void this.connect(), wait_ms);
  }
}
