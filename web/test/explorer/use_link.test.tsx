// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { ExplorerState } from "../../src/explorer/explorer_state";
import { toLayer } from "../../src/explorer/plane_moves";
import { useLink } from "../../src/explorer/use_link";
import { seenInExplorer } from "../../src/shell/explorer_link";
import { replaceHash } from "../../src/shell/route";
import { aSample } from "./a_sample";

function View({ state }: { state: ExplorerState }) {
  useLink(state);
  return null;
}

const layer21 = "#/explorer?normal=0,0,1&through=4995,4995,400";

describe("the explorer's address", () => {
  beforeEach(() => {
    vi.useFakeTimers();
    seenInExplorer.value = "#/explorer";
    replaceHash("#/explorer");
  });
  afterEach(() => {
    leave();
    vi.useRealTimers();
  });

  const open = (): ExplorerState => {
    const state = new ExplorerState();
    void act(() => render(<View state={state} />, document.body));
    state.learn(aSample);
    return state;
  };
  const leave = () => void act(() => render(null, document.body));

  it("follows the view once the hand rests", () => {
    const state = open();
    toLayer(state, 21);
    vi.advanceTimersByTime(300);
    expect(location.hash).toBe(layer21);
  });

  it("without a view is of the one that was seen last, even a moment ago", () => {
    toLayer(open(), 21);
    leave();
    replaceHash("#/layers");
    expect(seenInExplorer.value).toBe(layer21);
    replaceHash("#/explorer");
    const state = open();
    expect(location.hash).toBe(layer21);
    expect(state.placed.value!.offset).toBe(400);
  });

  it("that names a view is of that one", () => {
    seenInExplorer.value = layer21;
    replaceHash("#/explorer?normal=0,1,0&through=0,50,0");
    expect(open().placed.value!.offset).toBe(50);
  });
});
