// @vitest-environment happy-dom
import { computed, signal } from "@preact/signals";
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, describe, expect, it } from "vitest";

import { ExplorerState } from "../../src/explorer/explorer_state";
import { inPlane } from "../../src/explorer/geometry/plane_rectangle";
import type { Vector3 } from "../../src/explorer/geometry/vector3";
import { projected, projectionOf } from "../../src/explorer/orbit_camera";
import { type Place, nearestEdge } from "../../src/explorer/section_edge";
import { SectionTools } from "../../src/explorer/section_tools";
import { pixelAt } from "../../src/explorer/section_window";
import { useCuboidPointer } from "../../src/explorer/use_cuboid_pointer";
import { useSectionPointer } from "../../src/explorer/use_section_pointer";
import { aSample } from "./a_sample";

const square: Place[] = [
  [10, 10],
  [90, 10],
  [90, 90],
  [10, 90],
];

describe("the nearest edge", () => {
  it.each([
    [[50, 12], 0],
    [[85, 50], 1],
    [[50, 95], 2],
    [[4, 50], 3],
  ] as [Place, number][])("at %j is %d", (place, edge) => {
    expect(nearestEdge(square, place, 8)).toBe(edge);
  });

  it("is none where all are far, nor beyond an edge's end", () => {
    expect(nearestEdge(square, [50, 50], 8)).toBeNull();
    expect(nearestEdge(square, [110, 10], 8)).toBeNull();
    expect(nearestEdge([], [0, 0], 8)).toBeNull();
  });
});

describe("a click on an edge of the section", () => {
  const page = document.createElement("div");
  const view = computed(() => projectionOf(state.camera.value, state.far.value, 400, 300));
  const handles = computed(() =>
    state.placed.value!.points.map((point) => projected(view.value, point)),
  );
  let state: ExplorerState;
  let tools: SectionTools;

  function Pointers() {
    const box = { current: page.querySelector<HTMLDivElement>("#section") };
    const canvas = { current: page.querySelector<HTMLCanvasElement>("#block") };
    useSectionPointer(box, state, tools, signal(null));
    useCuboidPointer(canvas, state, view, handles, signal(null));
    return null;
  }

  beforeEach(async () => {
    state = new ExplorerState();
    tools = new SectionTools();
    state.panel.value = { width: 1000, height: 700, ratio: 2 };
    state.learn(aSample);
    page.innerHTML = '<div id="section"></div><canvas id="block"></canvas><div id="hooks"></div>';
    for (const id of ["section", "block"]) {
      page.querySelector<HTMLElement>(`#${id}`)!.setPointerCapture = () => undefined;
    }
    await act(() => render(<Pointers />, page.querySelector("#hooks")!));
  });
  afterEach(() => render(null, page.querySelector("#hooks")!));

  const press = (id: string, [x, y]: Place, [right, down]: Place = [0, 0], end = "pointerup") => {
    const tell = (type: string, place: Place) =>
      page.querySelector(`#${id}`)!.dispatchEvent(
        new PointerEvent(type, {
          pointerId: 1,
          pointerType: "mouse",
          button: 0,
          clientX: place[0],
          clientY: place[1],
        }),
      );
    tell("pointerdown", [x, y]);
    if (right !== 0 || down !== 0) tell("pointermove", [x + right, y + down]);
    tell(end, [x + right, y + down]);
  };
  /** Between two vertices, nearer to the first. */
  const onEdge = (edge: number): Vector3 => {
    const { polygon } = state.placed.value!;
    const [a, b] = [polygon[edge], polygon[(edge + 1) % polygon.length]];
    return [0, 1, 2].map((i) => a[i] + 0.4 * (b[i] - a[i])) as unknown as Vector3;
  };
  const inSection = (point: Vector3): Place => {
    const window = state.window.value!;
    const [x, y] = pixelAt(window, inPlane(window.frame, point));
    return [x / 2, y / 2];
  };
  const inBlock = (point: Vector3): Place => projected(view.value, point);
  const theta = () => state.choices.value.theta;

  it("chooses the largest rectangle on it, in the section and in the block", () => {
    for (const edge of [0, 1, 2, 3]) {
      state.choose({ theta: { kind: "bounding" } });
      press("section", inSection(onEdge(edge)));
      expect(theta()).toEqual({ kind: "edge", edge });
      state.choose({ theta: { kind: "bounding" } });
      press("block", inBlock(onEdge(edge)));
      expect(theta()).toEqual({ kind: "edge", edge });
    }
  });

  it("is not what a drag, a press that the browser takes, or a press beside it is", () => {
    press("section", inSection(onEdge(1)), [0, 30]);
    press("block", inBlock(onEdge(1)), [30, 0]);
    press("section", inSection(onEdge(1)), [0, 0], "pointercancel");
    press("section", inSection(state.placed.value!.through));
    expect(theta()).toEqual({ kind: "bounding" });
  });

  it("leaves measuring, drawing and the points of the plane alone", () => {
    tools.take("measure");
    press("section", inSection(onEdge(1)));
    tools.take("rectangle");
    press("section", inSection(onEdge(1)));
    expect(theta()).toEqual({ kind: "bounding" });
    const [first] = state.placed.value!.points;
    press("block", inBlock(first));
    expect(theta()).toEqual({ kind: "bounding" });
    press("block", inBlock(first), [5, 20]);
    expect(state.placed.value!.points[0]).not.toEqual(first);
  });

  it("is no corner of a rectangle that is being drawn, which the browser may take away", () => {
    tools.take("rectangle");
    press("section", inSection(onEdge(1)), [-60, -40], "pointercancel");
    expect(theta()).toEqual({ kind: "bounding" });
    press("section", inSection(onEdge(1)), [-60, -40]);
    expect(theta().kind).toBe("custom");
  });

  it("does nothing while a series is shown, whose planes have other edges", () => {
    const at = inBlock(onEdge(1));
    state.frame.value = { placed: state.placed.value! } as never;
    press("block", at);
    expect(theta()).toEqual({ kind: "bounding" });
  });
});
