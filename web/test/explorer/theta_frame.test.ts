import { describe, expect, it } from "vitest";

import { sectionBasis } from "../../src/explorer/geometry/section_basis";
import { signedDistance } from "../../src/explorer/geometry/plane";
import { placePlane } from "../../src/explorer/plane_state";
import { customBetween, thetaFrame } from "../../src/explorer/theta_frame";

const knee = { size: [1000, 1000, 80], spacing: [10, 10, 20] } as const;
const placed = placePlane(
  { kind: "normal", normal: [1, 2, -3], through: [5000, 4000, 700] },
  knee,
)!;

describe("the rectangle of a section", () => {
  it("of one's own is put on the plane from wherever its corner is", () => {
    const frame = thetaFrame(
      { kind: "custom", corner: [1, 2, 3], width: 10, height: 20, angle: 30 },
      placed,
      "layer",
    )!;
    expect(signedDistance(placed.plane, frame.origin)).toBeCloseTo(0, 9);
    expect([frame.width, frame.height]).toEqual([10, 20]);
  });

  it("inside is the server's to find", () => {
    expect(thetaFrame({ kind: "inscribed" }, placed, "layer")).toBeNull();
  });

  it("is drawn between two corners, whichever comes first", () => {
    const basis = sectionBasis(
      "layer",
      placePlane({ kind: "normal", normal: [0, 0, 1], through: [0, 0, 0] }, knee)!.plane,
    );
    const drawn = { kind: "custom", corner: [10, 20, 0], width: 30, height: 20, angle: 0 };
    expect(customBetween(basis, 0, [10, 20, 0], [40, 40, 0])).toEqual(drawn);
    expect(customBetween(basis, 0, [40, 20, 0], [10, 40, 0])).toEqual(drawn);
    expect(customBetween(basis, 0, [40, 20, 0], [40, 40, 0])).toBeNull();
  });
});
