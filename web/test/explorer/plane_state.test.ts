import { describe, expect, it } from "vitest";

import type { Cuboid } from "../../src/explorer/geometry/cuboid";
import { signedDistance } from "../../src/explorer/geometry/plane";
import type { Vector3 } from "../../src/explorer/geometry/vector3";
import {
  alongLayers,
  alongXz,
  diagonal,
  nudged,
  placePlane,
  stepAlong,
  tidied,
  withAngles,
  withNormal,
  withOffset,
  withPoint,
} from "../../src/explorer/plane_state";
import type { PlaneDefinition } from "../../src/explorer/plane_state";

const knee: Cuboid = { size: [1000, 1000, 80], spacing: [10, 10, 20] };
const placed = (definition: PlaneDefinition) => placePlane(definition, knee)!;
const slanted = placed(withAngles(placed(alongLayers(knee, 40)), { tilt: 30, azimuth: 20 }));

describe("a placed plane", () => {
  it("holds its three points, wherever they came from", () => {
    for (const { plane, points } of [slanted, placed(alongXz([1, 2, 3]))]) {
      for (const point of points) expect(signedDistance(plane, point)).toBeCloseTo(0, 6);
    }
  });

  it("is none where the points lie on a line", () => {
    const line: Vector3[] = [
      [0, 0, 0],
      [1, 1, 1],
      [2, 2, 2],
    ];
    expect(placePlane({ kind: "points", points: line as never }, knee)).toBeNull();
  });

  it("that misses the block still has points to take hold of", () => {
    const beside = placed({ kind: "normal", normal: [0, 1, 2], through: [0, 0, -5000] });
    expect(beside.polygon.length).toBeLessThan(3);
    for (const point of beside.points) {
      expect(signedDistance(beside.plane, point)).toBeCloseTo(0, 6);
    }
    expect(placePlane({ kind: "points", points: beside.points }, knee)).not.toBeNull();
  });

  it("keeps the azimuth it had while it lies along the layers and has none", () => {
    expect(placePlane(alongLayers(knee, 3), knee, 55)!.angles).toEqual({ tilt: 0, azimuth: 55 });
  });
});

describe("moving a plane", () => {
  it("by one point leaves the others", () => {
    const moved = placed(withPoint(slanted, 1, [9990, 0, 123.4567]));
    expect(moved.points[1]).toEqual([9990, 0, 123.457]);
    moved.points[0].forEach((value, i) => expect(value).toBeCloseTo(slanted.points[0][i], 2));
  });

  it("by angles turns it about the point that it goes through", () => {
    const turned = placed(withAngles(slanted, { tilt: 75, azimuth: -100 }));
    expect(turned.angles.tilt).toBeCloseTo(75, 3);
    expect(turned.angles.azimuth).toBeCloseTo(-100, 3);
    expect(Math.abs(signedDistance(turned.plane, slanted.through))).toBeLessThan(0.01);
  });

  it("by its offset keeps its direction", () => {
    const moved = placed(withOffset(slanted, slanted.offset + 250, knee));
    expect(moved.offset).toBeCloseTo(slanted.offset + 250, 1);
    expect(moved.angles.tilt).toBeCloseTo(30, 3);
  });

  it("by its offset takes its three points along, there and back to the same plane", () => {
    for (const points of [diagonal(knee, 1580), withPoint(slanted, 0, [10.1234, 20.5678, 300.9])]) {
      const first = placed(points);
      const there = placed(nudged(first, 7, knee));
      expect(there.definition.kind).toBe("points");
      expect(there.offset).toBeCloseTo(first.offset + 7 * stepAlong(first.plane.normal, knee), 2);
      expect(nudged(there, -7, knee)).toEqual(points);
    }
  });

  it("leaves points behind that would be far from the block", () => {
    const steep = placed({
      kind: "points",
      points: [
        [0, 0, 0],
        [9990, 0, 0],
        [0, 9990, 1580],
      ],
    });
    expect(withOffset(steep, steep.offset + 1500, knee).kind).toBe("normal");
  });

  it("never takes it off the block", () => {
    for (const offset of [-1e6, 1e6]) {
      expect(placed(withOffset(slanted, offset, knee)).polygon.length).toBeGreaterThanOrEqual(3);
    }
  });

  it("by a normal keeps the normal as it was typed", () => {
    const typed = placed(withNormal(slanted, [1, 2, -3]));
    expect(typed.definition).toMatchObject({ normal: [1, 2, -3] });
    expect(typed.plane.normal[2]).toBeGreaterThan(0);
  });

  it("by a step along the layers goes to the next layer, not beyond the last", () => {
    expect(placed(nudged(placed(alongLayers(knee, 7)), 1, knee)).offset).toBe(140);
    expect(placed(nudged(placed(alongLayers(knee, 80)), 1, knee)).offset).toBe(1580);
    expect(placed(nudged(placed(alongLayers(knee, 1)), -3, knee)).offset).toBe(0);
  });

  it("by steps along y moves by voxels", () => {
    expect(placed(nudged(placed(alongXz([0, 5000, 0])), 3, knee)).offset).toBeCloseTo(5030, 6);
  });
});

describe("a plane by itself", () => {
  it("is told in numbers that people can read", () => {
    const third = placed({ kind: "normal", normal: [0, 1, 3], through: [1 / 3, 5000, 700] });
    const told = tidied(third);
    expect(told).toMatchObject({ kind: "normal", normal: [0, 0.316228, 0.948683] });
    expect(JSON.stringify(told).length).toBeLessThan(100);
    expect(placed(told).offset).toBeCloseTo(third.offset, 1);
  });

  it("keeps the exact depth of a layer", () => {
    const thirds: Cuboid = { size: [10, 10, 10], spacing: [1, 1, 10 / 3] };
    const layer = placePlane(alongLayers(thirds, 8), thirds)!;
    expect(tidied(layer)).toEqual(alongLayers(thirds, 8));
  });
});

describe("shortcuts", () => {
  it("put a layer at its exact depth", () => {
    const thirds: Cuboid = { size: [10, 10, 10], spacing: [1, 1, 10 / 3] };
    expect(alongLayers(thirds, 8)).toMatchObject({ through: [4.5, 4.5, 7 * (10 / 3)] });
  });

  it("cut the block from edge to edge", () => {
    expect(placed(diagonal(knee, 1580)).polygon.length).toBe(4);
  });
});
