import { describe, expect, it } from "vitest";

import {
  axisLabels,
  boxEdges,
  facesTowards,
  texturedPolygon,
} from "../../src/explorer/cuboid_scene";
import type { Vector3 } from "../../src/explorer/geometry/vector3";
import {
  projected,
  projectionOf,
  screenAxes,
  startingCamera,
} from "../../src/explorer/orbit_camera";
import type { SectionPicture } from "../../src/explorer/section_record";

const far: Vector3 = [100, 80, 20];
const { towards } = screenAxes(startingCamera);

describe("the block", () => {
  it("hides three of its edges, and none when it is seen along an axis", () => {
    const { hidden, visible } = boxEdges(far, towards);
    expect(hidden.length).toBe(3);
    expect(visible.length).toBe(9);
    expect(boxEdges(far, [0, 0, -1]).hidden.length).toBe(0);
  });

  it("turns three faces to the viewer, among them the front face's side", () => {
    const faces = facesTowards(far, [5, 20], towards);
    expect(faces.length).toBe(3);
    expect(faces.some((face) => face.every((point) => point[2] === 5))).toBe(true);
  });

  it("has a label beside each axis", () => {
    const view = projectionOf(startingCamera, far, 400, 300);
    const labels = axisLabels(far, (point) => projected(view, point));
    expect(labels.map(({ axis }) => axis)).toEqual([0, 1, 2]);
    expect(new Set(labels.map(({ x, y }) => `${x},${y}`)).size).toBe(3);
  });
});

it("labels make way for the handles of the plane and for each other", () => {
  const view = projectionOf(startingCamera, far, 400, 300);
  const project = (point: Vector3) => projected(view, point);
  const plain = axisLabels(far, project);
  const handles = plain.map(({ x, y }) => [x, y] as [number, number]);
  for (const { axis, x, y } of axisLabels(far, project, handles)) {
    const { x: before, y: above } = plain[axis];
    expect(Math.abs(x - before) >= 39 || Math.abs(y - above) >= 17).toBe(true);
  }
  const small = projectionOf(startingCamera, far, 90, 70);
  const [first, ...others] = axisLabels(far, (point) => projected(small, point));
  for (const { x, y } of others) {
    expect(Math.abs(x - first.x) >= 60 || Math.abs(y - first.y) >= 16).toBe(true);
  }
});

it("the picture covers the section from edge to edge of its pixels", () => {
  const record = {
    polygon_um: [
      [0, 0, 0],
      [90, 0, 0],
      [90, 40, 0],
      [0, 40, 0],
    ],
    rectangle: { origin_um: [0, 0, 0], p: [1, 0, 0], q: [0, 1, 0], width_um: 90, height_um: 40 },
    pixel_um: 10,
    picture: { width: 10, height: 5 },
  };
  const corners = texturedPolygon({ record } as unknown as SectionPicture);
  expect(corners.map(({ u }) => u)).toEqual([0.05, 0.95, 0.95, 0.05]);
  expect(corners.map(({ v }) => v)).toEqual([0.1, 0.1, 0.9, 0.9]);
});
