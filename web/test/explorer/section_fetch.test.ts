import { afterEach, expect, it, vi } from "vitest";

import { ConnectionError } from "../../src/api/client";
import { connection } from "../../src/api/live";
import { busyWait_ms, fetchPicture } from "../../src/explorer/section_fetch";

afterEach(() => {
  vi.unstubAllGlobals();
});

it("of a picture that broke off asks for it again, as long as the server is heard of", async () => {
  const body = new ReadableStream({ start: (it) => it.error(new TypeError("reset")) });
  const headers = { "Biotomy-Section": "{}" };
  vi.stubGlobal("fetch", async () => new Response(body, { headers }));
  vi.stubGlobal("createImageBitmap", vi.fn());
  const picture = fetchPicture("/api/v1/section", new AbortController().signal);
  const error = await picture.catch((reason: unknown) => reason);
  expect(error).toBeInstanceOf(ConnectionError);
  connection.value = { ...connection.value, state: "live" };
  expect(busyWait_ms(error)).toBeGreaterThan(0);
  connection.value = { ...connection.value, state: "lost" };
  expect(busyWait_ms(error)).toBeNull();
});
