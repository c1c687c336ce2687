import { expect, it } from "vitest";

import { axisLabels } from "../../src/explorer/axis_labels";
import type { Vector3 } from "../../src/explorer/geometry/vector3";
import { projected, projectionOf, startingCamera } from "../../src/explorer/orbit_camera";

const far: Vector3 = [100, 80, 20];
const [width, height] = [400, 300];
const view = projectionOf(startingCamera, far, width, height);
const project = (point: Vector3) => projected(view, point);
const plain = axisLabels(far, project);
const handles = plain.map(({ x, y }) => [x, y] as const);

it("there is a label beside each axis", () => {
  expect(plain.map(({ axis }) => axis)).toEqual([0, 1, 2]);
  expect(new Set(plain.map(({ x, y }) => `${x},${y}`)).size).toBe(3);
});

it("labels make way for the handles of the plane", () => {
  for (const { axis, x, y } of axisLabels(far, project, handles)) {
    const [before, above] = handles[axis];
    expect(Math.abs(x - before) >= 39 || Math.abs(y - above) >= 17).toBe(true);
  }
});

it("they do so in the view, too, where there is no room beside", () => {
  const most = Math.max(...plain.map(({ x }) => x));
  const held = ([x, y]: readonly [number, number]) => [Math.min(most, x), y] as const;
  for (const { axis, x, y } of axisLabels(far, project, handles, held)) {
    const [before, above] = handles[axis];
    expect(x).toBeLessThanOrEqual(most);
    expect(Math.abs(x - before) >= 39 || Math.abs(y - above) >= 17).toBe(true);
  }
});

it("labels make way for each other", () => {
  const small = projectionOf(startingCamera, far, 90, 70);
  const [first, ...others] = axisLabels(far, (point) => projected(small, point));
  for (const { x, y } of others) {
    expect(Math.abs(x - first.x) >= 60 || Math.abs(y - first.y) >= 16).toBe(true);
  }
});
