import { describe, expect, it } from "vitest";

import type { Sample } from "../../src/api/types";
import type { Vector3 } from "../../src/explorer/geometry/vector3";
import { turned } from "../../src/explorer/geometry/vector3";
import { neuroglancerLink, quaternionOf } from "../../src/explorer/neuroglancer";
import { alongXz, placePlane } from "../../src/explorer/plane_state";

const sample = {
  name: "knee",
  size: [1000, 1000, 80],
  spacing_um: [10, 10, 20],
  volume_url: "/volume.ome.zarr",
} as unknown as Sample;

/** v turned by a quaternion (x, y, z, w). */
function rotated([x, y, z, w]: number[], [a, b, c]: Vector3): number[] {
  const t = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [
    a + w * t[0] + y * t[2] - z * t[1],
    b + w * t[1] + z * t[0] - x * t[2],
    c + w * t[2] + x * t[1] - y * t[0],
  ];
}

describe("the link to neuroglancer", () => {
  it("names the volume, its spacing and its colours", () => {
    const link = neuroglancerLink("https://viewer.example/", "http://rig:8080", sample, null);
    const [base, state] = link.split("/#!");
    expect(base).toBe("https://viewer.example");
    const { dimensions, layers } = JSON.parse(decodeURIComponent(state));
    expect(dimensions.z).toEqual([2e-5, "m"]);
    expect(layers[0].source.url).toBe("zarr3://http://rig:8080/volume.ome.zarr");
    expect(Object.keys(layers[0].source.transform.outputDimensions)).toEqual(["c^", "z", "y", "x"]);
    expect(layers[0].shader).toContain("emitRGB");
  });

  it("cuts where the page cuts", () => {
    const placed = placePlane(alongXz([4995, 500, 790]), {
      size: [1000, 1000, 80],
      spacing: [10, 10, 20],
    });
    const link = neuroglancerLink("https://viewer.example", "http://rig", sample, placed);
    const state = JSON.parse(decodeURIComponent(link.split("/#!")[1]));
    expect(state.position).toEqual([499.5, 50, 39.5]);
    rotated(state.crossSectionOrientation, [1, 0, 0]).forEach((value, i) =>
      expect(value).toBeCloseTo([1, 0, 0][i], 12),
    );
    rotated(state.crossSectionOrientation, [0, 1, 0]).forEach((value, i) =>
      expect(value).toBeCloseTo([0, 0, 1][i], 12),
    );
  });

  it("turns the screen as the section is turned, whatever the angle", () => {
    for (const angle of [0, 30, 120, 180, 250]) {
      const axis: Vector3 = [2 / 3, 1 / 3, 2 / 3];
      const [right, down, away] = (
        [
          [1, 0, 0],
          [0, 1, 0],
          [0, 0, 1],
        ] as Vector3[]
      ).map((v) => turned(v, axis, angle));
      const quaternion = quaternionOf(right, down, away);
      [right, down, away].forEach((wanted, i) => {
        const unit = [0, 1, 2].map((j) => (i === j ? 1 : 0)) as unknown as Vector3;
        rotated(quaternion, unit).forEach((value, j) => expect(value).toBeCloseTo(wanted[j], 9));
      });
    }
  });
});
