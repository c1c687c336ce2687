// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";

import { takeEvent } from "../../src/api/live";
import type { Attempt } from "../../src/api/types";
import { RejectedList } from "../../src/layers/RejectedList";

const page = document.createElement("div");
let journal: Attempt[]; // all rejected, the newest first

const rejected = (id: number, verdict = "rejected") =>
  ({ id, layer: id, attempt: 1, verdict, slug: "blurred", reason: "", metrics: [] }) as never;
const settle = () => act(() => new Promise((done) => setTimeout(done)));
const layers = () =>
  [...page.querySelectorAll("strong")].map((line) =>
    Number(/Layer (\d+)/.exec(line.innerText)![1]),
  );
const make = async (id: number, verdict?: string) => {
  const attempt = rejected(id, verdict);
  journal.unshift(attempt);
  await act(() => takeEvent({ name: "attempt", data: JSON.stringify(attempt), id: String(id) }));
  await settle();
};

beforeEach(async () => {
  journal = Array.from({ length: 70 }, (_, i) => rejected(70 - i));
  vi.stubGlobal("fetch", async (address: string) => {
    const query = new URL(address, "http://rig").searchParams;
    const before = Number(query.get("before") ?? Infinity);
    const older = journal.filter(({ id }) => id < before).slice(0, Number(query.get("limit")));
    return new Response(JSON.stringify({ count: journal.length, rejected: older }));
  });
  await act(() => render(<RejectedList />, page));
  await settle();
});
afterEach(() => {
  render(null, page);
  vi.unstubAllGlobals();
});

it("has the newest frames, and older ones when they are asked for", async () => {
  expect(layers()).toEqual(Array.from({ length: 50 }, (_, i) => 70 - i));
  await act(() => page.querySelector("button")!.click());
  await settle();
  expect(layers()).toHaveLength(70);
  expect(page.querySelector("button")).toBeNull();
});

it("asks for older ones again where the answer was lost", async () => {
  const answering = globalThis.fetch;
  vi.stubGlobal("fetch", () => Promise.reject(new TypeError("the connection was reset")));
  await act(() => page.querySelector("button")!.click());
  await settle();
  expect(layers()).toHaveLength(50);
  vi.stubGlobal("fetch", answering);
  await act(() => page.querySelector("button")!.click());
  await settle();
  expect(layers()).toHaveLength(70);
});

it("goes on to take in what is rejected after older ones were asked for", async () => {
  await act(() => page.querySelector("button")!.click());
  await settle();
  await make(71);
  expect(layers().slice(0, 2)).toEqual([71, 70]);
  await make(72, "not_stored");
  expect(layers()).toHaveLength(72);
});

it("fetches what was missed, and has no hole where that was much", async () => {
  journal.unshift(rejected(71));
  await act(() => takeEvent({ name: "reload", data: "{}", id: "" }));
  await settle();
  expect(layers()[0]).toBe(71);
  for (let id = 72; id <= 200; id += 1) journal.unshift(rejected(id));
  await act(() => takeEvent({ name: "reload", data: "{}", id: "" }));
  await settle();
  expect(layers()).toEqual(Array.from({ length: 50 }, (_, i) => 200 - i));
});
