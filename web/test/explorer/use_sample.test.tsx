// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it, vi } from "vitest";

import { sampleProgress } from "../../src/api/live";
import { ExplorerState } from "../../src/explorer/explorer_state";
import { useSample } from "../../src/explorer/use_sample";

const page = document.createElement("div");
let state: ExplorerState;
let status: number;

function Sample() {
  useSample(state);
  return null;
}
const open = () => act(() => render(<Sample />, page));
const settle = (ms = 1) => vi.advanceTimersByTimeAsync(ms);

beforeEach(() => {
  vi.useFakeTimers();
  state = new ExplorerState();
  status = 200;
  vi.stubGlobal("fetch", async () => {
    if (status === 0) throw new TypeError("no network");
    const sample = { size: [10, 10, 10], spacing_um: [1, 1, 1], layers_present: 2, generation: 1 };
    return new Response(JSON.stringify(sample), { status });
  });
});
afterEach(() => {
  render(null, page);
  sampleProgress.value = null;
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

it("says that there is nothing yet, and learns of the sample once there is", async () => {
  sampleProgress.value = { committed: 0, layers_present: 0, created: null, generation: 0 };
  await open();
  expect(state.failure.value).toMatch(/No layer/);
  sampleProgress.value = { committed: 1, layers_present: 1, created: null, generation: 1 };
  await settle();
  expect(state.sample.value?.size).toEqual([10, 10, 10]);
  expect(state.failure.value).toBe("");
});

it.each([503, 0])("asks again by itself after an answer that will pass (%d)", async (answer) => {
  status = answer;
  sampleProgress.value = { committed: 1, layers_present: 1, created: null, generation: 1 };
  await open();
  await settle();
  expect(state.failure.value).not.toBe("");
  status = 200;
  await settle(10_000);
  expect(state.sample.value).not.toBeNull();
  expect(state.failure.value).toBe("");
});
