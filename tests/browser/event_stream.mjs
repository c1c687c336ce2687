/** The events of the daemon, one after another, until close(): {name, data, id}. */
export function readEvents(rig, { token, lastId } = {}) {
  const end = new AbortController();
  async function* events() {
    const headers = lastId === undefined ? {} : { "Last-Event-ID": String(lastId) };
    const response = await rig.ask("/api/v1/events", { token, headers, signal: end.signal });
    if (!response.ok) throw new Error(`events: ${response.status} ${await response.text()}`);
    let text = "";
    for await (const piece of response.body.pipeThrough(new TextDecoderStream())) {
      text += piece;
      const blocks = text.split("\n\n");
      text = blocks.pop();
      for (const block of blocks) {
        const fields = { event: "message", data: [], id: "" };
        for (const line of block.split("\n")) {
          const [, field, value] = /^(\w*): ?(.*)$/.exec(line) ?? [];
          if (field === "data") fields.data.push(value);
          else if (field) fields[field] = value;
        }
        if (fields.data.length)
          yield { name: fields.event, data: fields.data.join("\n"), id: fields.id };
      }
    }
  }
  const stream = events();
  return { [Symbol.asyncIterator]: () => stream, close: () => end.abort() };
}
