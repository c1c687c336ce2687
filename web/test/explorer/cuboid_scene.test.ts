import { describe, expect, it } from "vitest";

import { boxEdges, facesTowards, texturedPolygon } from "../../src/explorer/cuboid_scene";
import type { Vector3 } from "../../src/explorer/geometry/vector3";
import { screenAxes, startingCamera } from "../../src/explorer/orbit_camera";
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
