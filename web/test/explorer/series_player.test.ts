import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { ApiError, getJson } from "../../src/api/client";
import { ExplorerState } from "../../src/explorer/explorer_state";
import { fetchPicture } from "../../src/explorer/section_fetch";
import type { SectionRecord } from "../../src/explorer/section_record";
import { SeriesPlayer } from "../../src/explorer/series_player";
import { aSample } from "./a_sample";

vi.mock("../../src/api/client", async (original) => ({
  ...(await original<object>()),
  getJson: vi.fn(),
}));
vi.mock("../../src/explorer/section_fetch", async (original) => ({
  ...(await original<object>()),
  fetchPicture: vi.fn(),
}));

const frameCount = 30;
const frames = Array.from({ length: frameCount }, (_, index) => ({
  index,
  value: index,
  label: `${index}`,
  cuts: index !== 0 && index !== 4,
  plane: { normal: [0, 0, 1], offset_um: -20 * index },
}));

let asked: URLSearchParams[];
let state: ExplorerState;
let player: SeriesPlayer;

beforeEach(() => {
  vi.useFakeTimers();
  asked = [];
  vi.mocked(getJson).mockResolvedValue({ unit: "um", frames });
  vi.mocked(fetchPicture).mockImplementation((address) => {
    asked.push(new URL(address, "http://rig").searchParams);
    const image = { close() {} } as unknown as ImageBitmap;
    const record = { pixel_um: 10, polygon_um: [] } as unknown as SectionRecord;
    return Promise.resolve({ image, record });
  });
  state = new ExplorerState();
  state.panel.value = { width: 1000, height: 700, ratio: 1 };
  state.learn(aSample);
  player = new SeriesPlayer(state);
});
afterEach(() => {
  player.close();
  vi.useRealTimers();
});

const indices = () => asked.map((query) => Number(query.get("index")));

describe("a series that plays", () => {
  it("shows one frame after the other, ahead of which others are fetched", async () => {
    await player.play();
    await vi.advanceTimersByTimeAsync(550);
    expect(player.index.value).toBe(5);
    expect(state.frame.value!.placed.offset).toBe(100);
    expect(Math.max(...indices())).toBeGreaterThan(12);
    expect(asked.every((query) => query.get("format") === "jpeg")).toBe(true);
  });

  it("passes over frames whose plane misses the block, and asks for none of them", async () => {
    await player.play();
    await vi.advanceTimersByTimeAsync(1000);
    expect(indices()).not.toContain(0);
    expect(indices()).not.toContain(4);
  });

  it("waits for a frame that has not come", async () => {
    vi.mocked(fetchPicture).mockReturnValue(new Promise(() => {}));
    await player.play();
    await vi.advanceTimersByTimeAsync(2000);
    expect(player.index.value).toBe(1);
    expect(player.waiting.value).toBe(true);
  });

  it("shows the frame sharply when it is paused, and ends at its last", async () => {
    await player.play();
    await vi.advanceTimersByTimeAsync(frameCount * 100 + 500);
    expect(player.playing.value).toBe(false);
    expect(player.index.value).toBe(frameCount - 1);
    expect(state.frame.value!.picture.sharp).toBe(true);
    expect(asked[asked.length - 1].get("fit")).toBe("1000x700");
  });

  it("gives the plane of its frame to go on with", async () => {
    await player.play();
    await vi.advanceTimersByTimeAsync(350);
    player.cutHere();
    expect(state.frame.value).toBeNull();
    expect(state.placed.value!.offset).toBeCloseTo(60, 6);
    expect(player.frames.value).toEqual([]);
  });

  it("goes back to the plane it began from", async () => {
    const before = state.definition.value;
    await player.play();
    await vi.advanceTimersByTimeAsync(350);
    player.close();
    expect(state.frame.value).toBeNull();
    expect(state.definition.value).toBe(before);
  });

  it("tells why there is none", async () => {
    vi.mocked(getJson).mockRejectedValue(new Error("the step leads nowhere"));
    await player.play();
    expect(player.failure.value).toBe("the step leads nowhere");
    expect(player.playing.value).toBe(false);
    player.close();
    expect(player.failure.value).toBe("");
  });

  it("stops at a frame that can't be had and says why, and tries it again when asked", async () => {
    const answer = vi.mocked(fetchPicture).getMockImplementation()!;
    vi.mocked(fetchPicture).mockImplementation((address, signal) =>
      /index=9\b/.test(address)
        ? Promise.reject(new Error("the network is gone"))
        : answer(address, signal),
    );
    await player.play();
    await vi.advanceTimersByTimeAsync(500);
    expect(player.playing.value).toBe(true);
    await vi.advanceTimersByTimeAsync(1000);
    expect(player.playing.value).toBe(false);
    expect(player.index.value).toBe(9);
    expect(player.failure.value).toBe("the network is gone");
    vi.mocked(fetchPicture).mockImplementation(answer);
    await player.play();
    await vi.advanceTimersByTimeAsync(550);
    expect(player.failure.value).toBe("");
    expect(player.index.value).toBeGreaterThan(12);
  });

  it("waits as long as a busy server says, and then goes on", async () => {
    const answer = vi.mocked(fetchPicture).getMockImplementation()!;
    vi.mocked(fetchPicture).mockRejectedValueOnce(new ApiError(503, "busy", "too much to do", 2));
    await player.play();
    await vi.advanceTimersByTimeAsync(1900);
    expect(player.index.value).toBe(1);
    vi.mocked(fetchPicture).mockImplementation(answer);
    await vi.advanceTimersByTimeAsync(400);
    expect(player.index.value).toBeGreaterThan(1);
    expect(player.failure.value).toBe("");
  });

  it("asks a busy server for the sharp frame when it says, not before", async () => {
    const answer = vi.mocked(fetchPicture).getMockImplementation()!;
    let sharp = 0;
    vi.mocked(fetchPicture).mockImplementation((address, signal) => {
      if (!address.includes("format=png") || ++sharp > 1) return answer(address, signal);
      return Promise.reject(new ApiError(503, "busy", "too much to do", 2));
    });
    await player.scrub(9);
    await vi.advanceTimersByTimeAsync(1900);
    expect(sharp).toBe(1);
    await vi.advanceTimersByTimeAsync(500);
    expect(sharp).toBe(2);
    expect(state.frame.value!.picture.sharp).toBe(true);
  });

  it.each(["scrub", "play"] as const)("gives up the sharp frame at the next %s", async (next) => {
    const answer = vi.mocked(fetchPicture).getMockImplementation()!;
    const given: AbortSignal[] = [];
    vi.mocked(fetchPicture).mockImplementation((address, signal) => {
      if (!address.includes("format=png")) return answer(address, signal);
      given.push(signal);
      return new Promise(() => {});
    });
    await player.scrub(9);
    await vi.advanceTimersByTimeAsync(300);
    expect(given.map(({ aborted }) => aborted)).toEqual([false]);
    await player[next](12);
    expect(given.map(({ aborted }) => aborted)).toEqual([true]);
  });

  it("that was closed before its frames were known does not open after all", async () => {
    let answer = (_: unknown) => {};
    vi.mocked(getJson).mockReturnValue(new Promise((resolve) => (answer = resolve)));
    const played = player.play();
    player.close();
    answer({ frames });
    await played;
    expect(player.frames.value).toEqual([]);
    expect(player.playing.value).toBe(false);
  });

  it("gives back the memory of all but some pictures", async () => {
    let open = 0;
    vi.mocked(getJson).mockResolvedValue({
      frames: Array.from({ length: 200 }, (_, index) => ({ ...frames[1], index, value: index })),
    });
    vi.mocked(fetchPicture).mockImplementation(() => {
      open += 1;
      const image = { close: () => (open -= 1) } as unknown as ImageBitmap;
      const record = { pixel_um: 10, polygon_um: [] } as unknown as SectionRecord;
      return Promise.resolve({ image, record });
    });
    await player.play();
    await vi.advanceTimersByTimeAsync(15_000);
    expect(player.index.value).toBeGreaterThan(140);
    expect(open).toBeLessThanOrEqual(48);
    player.close();
    expect(open).toBe(0);
  });
});
