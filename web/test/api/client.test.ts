// @vitest-environment happy-dom
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import {
  ApiError,
  ConnectionError,
  getBlob,
  getJson,
  longestAnswer_ms,
  postJson,
  withQuery,
} from "../../src/api/client";
import { askAgain, setToken, token, tokenQuestion } from "../../src/api/token";

const json = (value: unknown, status = 200, headers = {}) =>
  new Response(JSON.stringify(value), { status, headers });
const refused = (status: number, message: string, headers = {}) =>
  json({ error: { code: "no", message } }, status, headers);
const settle = () => new Promise((resolve) => setTimeout(resolve));

describe("requests", () => {
  const fetched = vi.fn<typeof fetch>();

  beforeEach(() => {
    fetched.mockReset();
    vi.stubGlobal("fetch", fetched);
    setToken("");
    askAgain();
  });

  afterEach(() => {
    vi.unstubAllGlobals();
  });

  const headersOf = (call: number) => new Headers(fetched.mock.calls[call][1]?.headers);

  it("answer with what was sent", async () => {
    fetched.mockResolvedValue(json({ a: 1 }));
    expect(await getJson("/x")).toEqual({ a: 1 });
    expect(headersOf(0).has("Authorization")).toBe(false);
  });

  it("throw the server's sentence, its status and when to come again", async () => {
    fetched.mockResolvedValue(refused(503, "too much to do", { "Retry-After": "2" }));
    const error = await getJson("/x").catch((reason: unknown) => reason);
    expect(error).toBeInstanceOf(ApiError);
    expect(error).toMatchObject({ status: 503, message: "too much to do", retryAfter: 2 });
  });

  it("throw something readable of an answer that is not ours", async () => {
    fetched.mockResolvedValue(new Response("<html>", { status: 502, statusText: "Bad Gateway" }));
    await expect(getJson("/x")).rejects.toThrow("The server answered 502 Bad Gateway.");
  });

  it("throw ConnectionError without an answer, and the abort as it is", async () => {
    fetched.mockRejectedValueOnce(new TypeError("failed"));
    await expect(getJson("/x")).rejects.toBeInstanceOf(ConnectionError);
    fetched.mockRejectedValueOnce(new DOMException("stopped", "AbortError"));
    await expect(getJson("/x")).rejects.toMatchObject({ name: "AbortError" });
  });

  it("throw ConnectionError, too, for an answer that breaks off, and the abort as it is", async () => {
    const broken = (error: unknown) =>
      new Response(new ReadableStream({ start: (controller) => controller.error(error) }));
    fetched.mockImplementation(async () => broken(new TypeError("the connection was reset")));
    await expect(getJson("/x")).rejects.toBeInstanceOf(ConnectionError);
    await expect(getBlob("/x")).rejects.toBeInstanceOf(ConnectionError);
    await expect(postJson("/x")).rejects.toBeInstanceOf(ConnectionError);
    fetched.mockImplementation(async () => broken(new DOMException("given up", "AbortError")));
    await expect(getBlob("/x")).rejects.toMatchObject({ name: "AbortError" });
  });

  it("that change something do not wait for ever, from when they are sent", async () => {
    const timeout = vi.spyOn(AbortSignal, "timeout");
    fetched.mockResolvedValueOnce(refused(401, "a token is needed"));
    const given = postJson("/b");
    await settle();
    expect(timeout).toHaveBeenCalledTimes(1);
    fetched.mockRejectedValueOnce(new DOMException("too long", "TimeoutError"));
    tokenQuestion.value?.answer("secret");
    await expect(given).rejects.toBeInstanceOf(ConnectionError);
    expect(timeout).toHaveBeenCalledTimes(2);
    expect(timeout).toHaveBeenLastCalledWith(longestAnswer_ms);
    expect(fetched.mock.calls[1][1]?.signal).toBe(timeout.mock.results[1].value);
  });

  it("ask once for a token, and send it in the header alone", async () => {
    fetched.mockImplementation(async (_path, init) =>
      new Headers(init?.headers).get("Authorization") === "Bearer secret"
        ? json({ ok: true })
        : refused(401, "a token is needed"),
    );
    const answers = Promise.all([getJson("/a"), postJson("/b", { reason: "x" })]);
    await settle();
    tokenQuestion.value?.answer("secret");
    expect(await answers).toEqual([{ ok: true }, { ok: true }]);
    expect(tokenQuestion.value).toBeNull();
    for (const [path] of fetched.mock.calls) expect(String(path)).not.toContain("secret");
  });

  it("fail with the server's sentence when the person gives no token", async () => {
    fetched.mockImplementation(async () => refused(401, "a token is needed"));
    const answer = getJson("/a").catch((reason: unknown) => reason);
    await settle();
    tokenQuestion.value?.answer(null);
    expect(await answer).toMatchObject({ status: 401, message: "a token is needed" });
  });

  it.each([401, 403])("forget a token that is answered %i", async (status) => {
    setToken("wrong");
    const asking = { "WWW-Authenticate": 'Bearer error="invalid_token"' };
    fetched.mockImplementation(async () => refused(status, "no", asking));
    const answer = getJson("/a").catch((reason: unknown) => reason);
    await settle();
    expect(tokenQuestion.value?.why).toContain("not accepted");
    tokenQuestion.value?.answer(null);
    await answer;
    expect(token()).toBe("");
  });
});

describe("a refusal that no token would change", () => {
  it.each(["", "right"])("is told as it is, and takes no token away (%j)", async (held) => {
    setToken(held);
    vi.stubGlobal("fetch", async () => refused(403, "not from there"));
    const answer = postJson("/x").catch((reason: unknown) => reason);
    await settle();
    expect(tokenQuestion.value).toBeNull();
    expect(await answer).toMatchObject({ status: 403, message: "not from there" });
    expect(token()).toBe(held);
    setToken("");
    vi.unstubAllGlobals();
  });
});

describe("withQuery", () => {
  it("leaves out what is not given and encodes the rest", () => {
    expect(withQuery("/x", { a: "1 2", b: undefined, c: null, d: 0 })).toBe("/x?a=1+2&d=0");
    expect(withQuery("/x", {})).toBe("/x");
  });
});
