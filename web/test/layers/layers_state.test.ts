// @vitest-environment happy-dom
import { afterEach, beforeEach, expect, it, vi } from "vitest";

const settle = () => vi.advanceTimersByTimeAsync(1);

let live: typeof import("../../src/api/live");
let layers: typeof import("../../src/layers/layers_state");
let stop: () => void;
let journal: number[]; // layers, by the number of the attempt
let status: number;
let asked: string[];
let held: (() => void)[] | null; // answers on their way

const fetch = async (address: string): Promise<Response> => {
  asked.push(address);
  const answer =
    status !== 200
      ? new Response("{}", { status })
      : new Response(
          JSON.stringify({
            last: journal.length,
            id: journal.map((_, i) => i + 1),
            layer: journal,
            verdict: journal.map(() => "rejected"),
          }),
        );
  await new Promise<void>((done) => (held ? held.push(done) : done()));
  return answer;
};
const history = () => asked.filter((address) => address.includes("/history"));

beforeEach(async () => {
  vi.useFakeTimers();
  vi.resetModules(); // it lives as long as the page
  journal = [1];
  status = 200;
  asked = [];
  held = null;
  vi.stubGlobal("fetch", fetch);
  live = await import("../../src/api/live");
  layers = await import("../../src/layers/layers_state");
});
afterEach(() => {
  stop();
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

const begin = () => {
  live.sampleProgress.value = { committed: 1, layers_present: 1, created: null, generation: 1 };
  stop = layers.watchLayers();
};
const miss = () => live.takeEvent({ name: "reload", data: "{}", id: "" });

it("knows what was judged, and asks again for what it missed", async () => {
  begin();
  await settle();
  journal.push(7);
  miss();
  await settle();
  expect(layers.highest.value).toBe(7);
});

it("asks once more where it missed something while the answer was on its way", async () => {
  const onTheirWay: (() => void)[] = (held = []);
  begin();
  await settle();
  journal.push(7); // the answer on its way does not know of it
  miss();
  held = null;
  for (const release of onTheirWay) release();
  await settle();
  expect(layers.highest.value).toBe(7);
  expect(history()).toHaveLength(2);
});

it("asks a busy server again, and shows no trouble that will pass", async () => {
  status = 503;
  begin();
  await settle();
  expect(layers.historyTrouble.value).toBe("");
  status = 200;
  await vi.advanceTimersByTimeAsync(10_000);
  expect(layers.highest.value).toBe(1);
  status = 500;
  miss();
  await settle();
  expect(layers.historyTrouble.value).not.toBe("");
});
