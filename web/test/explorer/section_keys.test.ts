// @vitest-environment happy-dom
import { beforeEach, describe, expect, it, vi } from "vitest";

import { ExplorerState } from "../../src/explorer/explorer_state";
import { pressedOnSection } from "../../src/explorer/section_keys";
import { SectionTools } from "../../src/explorer/section_tools";
import { toLayer } from "../../src/explorer/plane_moves";
import { aSample } from "./a_sample";

let state: ExplorerState;
let tools: SectionTools;
const press = (key: string, options: KeyboardEventInit = {}) => {
  const event = new KeyboardEvent("keydown", { key, cancelable: true, ...options });
  pressedOnSection(event, state, tools);
  return event.defaultPrevented;
};

beforeEach(() => {
  state = new ExplorerState();
  state.panel.value = { width: 1000, height: 800, ratio: 2 };
  state.learn(aSample);
  toLayer(state, 21);
  tools = new SectionTools();
});

it("a key shows a voxel a pixel, another one all of it", () => {
  press("1");
  expect(state.closeup.value!.pixel).toBe(10);
  press("0");
  expect(state.closeup.value).toBeNull();
});

describe("while measuring", () => {
  beforeEach(() => {
    tools.take("measure");
    state.sampleUnder = vi.fn(([x, y]) => [x, y, 400] as const);
  });

  it("arrow keys move a cross from the middle, and Enter takes its place", () => {
    const before = state.definition.value;
    expect(press("Enter")).toBe(true);
    expect(tools.measured.value).toEqual({ from: [250, 200, 400], to: null });
    press("ArrowRight");
    press("ArrowUp", { shiftKey: true });
    press("Enter");
    expect(tools.measured.value?.to).toEqual([266, 199, 400]);
    expect(state.definition.value).toBe(before);
  });

  it("the cross stays in the panel, and other keys do what they do", () => {
    for (let times = 0; times < 50; times += 1) press("ArrowLeft");
    expect(tools.pointer.value).toEqual([0, 200]);
    press("Escape");
    expect(tools.tool.value).toBe("look");
    expect(press("Enter")).toBe(false);
  });
});
