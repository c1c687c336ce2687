// @vitest-environment happy-dom
import { signal } from "@preact/signals";
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";

import { replaceHash } from "../../src/shell/route";
import { useViewLink } from "../../src/layers/view_link";
import type { Viewport } from "../../src/layers/viewport";

const viewport = signal<Viewport | null>(null);
const pixel = { x: 10, y: 10 };
const page = document.createElement("div");

function Linked() {
  useViewLink(viewport, pixel);
  return null;
}

async function open(hash: string) {
  replaceHash(hash);
  await act(() => render(<Linked />, page));
}

beforeEach(() => vi.useFakeTimers());
afterEach(() => {
  render(null, page);
  vi.useRealTimers();
});

it("shows what the address names", async () => {
  await open("#/layers/3?at=100,200&zoom=2");
  expect(viewport.value).toEqual({ x: 10.5, y: 20.5, scale: 2 });
});

it("shows the whole picture when the address names no part of it", async () => {
  viewport.value = { x: 1, y: 1, scale: 1 };
  await open("#/layers/3");
  expect(viewport.value).toBeNull();
});

it("follows another address", async () => {
  await open("#/layers/3?at=100,200&zoom=2");
  replaceHash("#/layers/4?at=0,0&zoom=1");
  expect(viewport.value).toEqual({ x: 0.5, y: 0.5, scale: 1 });
});

it("writes what is seen when the hand rests, and leaves the rest of the address", async () => {
  await open("#/layers/3?attempt=2");
  viewport.value = { x: 5, y: 5, scale: 1 };
  vi.advanceTimersByTime(200);
  viewport.value = { x: 10.5, y: 20.5, scale: 2 };
  vi.advanceTimersByTime(299);
  expect(location.hash).toBe("#/layers/3?attempt=2");
  vi.advanceTimersByTime(1);
  expect(location.hash).toBe("#/layers/3?attempt=2&at=100%2C200&zoom=2");
  viewport.value = null;
  vi.advanceTimersByTime(300);
  expect(location.hash).toBe("#/layers/3?attempt=2");
});

it("keeps the very view that it wrote", async () => {
  await open("#/layers/3");
  const view = { x: 10.51234, y: 20.5, scale: 2 };
  viewport.value = view;
  vi.advanceTimersByTime(300);
  expect(viewport.value).toBe(view);
});
