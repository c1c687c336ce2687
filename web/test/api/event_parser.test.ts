import { describe, expect, it } from "vitest";

import { EventParser } from "../../src/api/event_parser";

const parsed = (...pieces: string[]) => {
  const parser = new EventParser();
  return pieces.flatMap((piece) => parser.push(piece));
};

describe("EventParser", () => {
  it("reads the name, the data and the id", () => {
    expect(parsed('event: attempt\nid: 17\ndata: {"a":1}\n\n')).toEqual([
      { name: "attempt", data: '{"a":1}', id: "17" },
    ]);
  });

  it("reads the same however the stream is cut", () => {
    const text = ": \n\nevent: status\ndata: one\ndata: two\n\nid: 4\nevent: sample\ndata: µ\n\n";
    const whole = parsed(text);
    expect(whole).toHaveLength(2);
    for (let cut = 0; cut <= text.length; cut += 1) {
      expect(parsed(text.slice(0, cut), text.slice(cut))).toEqual(whole);
    }
    expect(parsed(...text)).toEqual(whole);
  });

  it("takes each kind of line break, and a carriage return at the end of a piece", () => {
    const expected = [{ name: "a", data: "1", id: "" }];
    expect(parsed("event: a\r\ndata: 1\r\n\r\n")).toEqual(expected);
    expect(parsed("event: a\r", "\ndata: 1\r", "\n\r", "\n")).toEqual(expected);
    expect(parsed("event: a\rdata: 1\r\r:")).toEqual(expected);
  });

  it("leaves out comments and events without data", () => {
    expect(parsed(": here\n\nevent: a\n\nid: 3\n\n")).toEqual([]);
  });

  it("keeps the last id for the events after it", () => {
    expect(parsed("id: 3\ndata: a\n\ndata: b\n\n").map((event) => event.id)).toEqual(["3", "3"]);
    const again = new EventParser("9");
    expect(again.push("data: c\n\n")).toEqual([{ name: "message", data: "c", id: "9" }]);
  });

  it("does not carry a name over to the next event", () => {
    expect(parsed("event: a\ndata: 1\n\ndata: 2\n\n").map((event) => event.name)).toEqual([
      "a",
      "message",
    ]);
  });

  it("reads a field without a colon and takes one space off a value", () => {
    expect(parsed("data\n\n")).toEqual([{ name: "message", data: "", id: "" }]);
    expect(parsed("data:  a\n\n")[0].data).toBe(" a");
    expect(parsed("data:a:b\n\n")[0].data).toBe("a:b");
  });

  it("does not hand out an event that has not ended", () => {
    expect(parsed("event: a\ndata: 1\n")).toEqual([]);
  });
});
