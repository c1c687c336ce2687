/** One event of a text/event-stream. */
export interface StreamEvent {
  name: string; // "message" when the stream names none
  data: string;
  id: string; // the last that was sent, with this event or before it
}

/**
 * Takes the stream in pieces of any length and hands out the events in it, as the HTML standard
 * reads them (Server-sent events, "Interpreting an event stream").
 */
export class EventParser {
  private rest = "";
  private name = "";
  private data: string[] = [];
  private id = "";

  /** `lastId`: of the connection before. */
  constructor(lastId = "") {
    this.id = lastId;
  }

  push(text: string): StreamEvent[] {
    const events: StreamEvent[] = [];
    this.rest += text;
    for (;;) {
      const end = this.rest.search(/[\r\n]/);
      if (end < 0) return events;
      // A carriage return at the very end may be the first half of one line break.
      if (this.rest[end] === "\r" && end + 1 === this.rest.length) return events;
      const line = this.rest.slice(0, end);
      this.rest = this.rest.slice(this.rest.startsWith("\r\n", end) ? end + 2 : end + 1);
      const event = this.take(line);
      if (event) events.push(event);
    }
  }

  private take(line: string): StreamEvent | null {
    if (line === "") return this.dispatch();
    const colon = line.indexOf(":");
    if (colon === 0) return null; // a comment
    const field = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? "" : line.slice(colon + 1).replace(/^ /, "");
    if (field === "event") this.name = value;
    else if (field === "data") this.data.push(value);
    else if (field === "id" && !value.includes("\0")) this.id = value;
    return null;
  }

  private dispatch(): StreamEvent | null {
    const { name, data, id } = this;
    this.name = "";
    this.data = [];
    return data.length === 0 ? null : { name: name || "message", data: data.join("\n"), id };
  }
}
