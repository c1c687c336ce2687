import { describe, expect, it } from "vitest";

import { extent, layerAt } from "../../src/explorer/geometry/cuboid";
import type { Cuboid } from "../../src/explorer/geometry/cuboid";
import {
  anglesOf,
  normalOf,
  planeFromNormal,
  planeThroughPoints,
  widestTriangle,
} from "../../src/explorer/geometry/plane";
import {
  angleFrom,
  boundingRectangle,
  clippedTo,
  cornersOf,
  inPlane,
  inSample,
  turnedBasis,
} from "../../src/explorer/geometry/plane_rectangle";
import { sectionBasis } from "../../src/explorer/geometry/section_basis";
import { sectionPolygon } from "../../src/explorer/geometry/section_polygon";
import { dot, norm, turned } from "../../src/explorer/geometry/vector3";
import type { Vector3 } from "../../src/explorer/geometry/vector3";

const knee: Cuboid = { size: [1000, 1000, 80], spacing: [10, 10, 20] };

const expectNear = (found: readonly Vector3[], wanted: readonly Vector3[]) => {
  expect(found.length).toBe(wanted.length);
  found.forEach((point, i) =>
    point.forEach((value, axis) => expect(value).toBeCloseTo(wanted[i][axis], 6)),
  );
};

// What `biotomy section --json` says of the same planes.
const known = [
  {
    plane: planeThroughPoints([
      [0, 0, 0],
      [9990, 0, 0],
      [9990, 9990, 1580],
    ]),
    basis: "layer" as const,
    polygon: [
      [0, 0, 0],
      [0, 9990, 1580],
      [9990, 9990, 1580],
      [9990, 0, 0],
    ] as Vector3[],
    origin: [0, 0, 0] as Vector3,
    width: 9990,
    height: 10114.173223748938,
  },
  {
    plane: planeFromNormal([1, 2, -3], [5000, 4000, 700]),
    basis: "xz" as const,
    polygon: [
      [0, 5450, 0],
      [0, 7820, 1580],
      [9990, 2825, 1580],
      [9990, 455, 0],
    ] as Vector3[],
    origin: [999, 455, -2997] as Vector3,
    width: 9976.986017831237,
    height: 8714.385520505733,
  },
  {
    plane: planeFromNormal([0, 0, 1], [0, 0, 100]),
    basis: "layer" as const,
    polygon: [
      [0, 0, 100],
      [9990, 0, 100],
      [9990, 9990, 100],
      [0, 9990, 100],
    ] as Vector3[],
    origin: [0, 0, 100] as Vector3,
    width: 9990,
    height: 9990,
  },
];

describe("a section's polygon and rectangle", () => {
  it.each(known)("are those of the tool", ({ plane, basis, polygon, origin, width, height }) => {
    const found = sectionPolygon(plane!, knee);
    expectNear(found, polygon);
    const rectangle = boundingRectangle(found, sectionBasis(basis, plane!));
    expectNear([rectangle.origin], [origin]);
    expect(rectangle.width).toBeCloseTo(width, 6);
    expect(rectangle.height).toBeCloseTo(height, 6);
  });

  it("has up to six corners", () => {
    const cube: Cuboid = { size: [11, 11, 11], spacing: [1, 1, 1] };
    const through = planeFromNormal([1, 1, 1], [5, 5, 5])!;
    expect(sectionPolygon(through, cube).length).toBe(6);
  });

  it("has too few corners where the plane misses the block or touches it", () => {
    expect(sectionPolygon(planeFromNormal([1, 1, 1], [-1, 0, 0])!, knee).length).toBe(0);
    expect(sectionPolygon(planeFromNormal([1, 1, 1], [0, 0, 0])!, knee).length).toBe(1);
  });

  it("is the face where the plane lies in it", () => {
    expect(sectionPolygon(planeFromNormal([0, 0, 1], [0, 0, 0])!, knee).length).toBe(4);
  });
});

describe("a plane", () => {
  it("is not made of points on a line, or of no direction", () => {
    expect(
      planeThroughPoints([
        [0, 0, 0],
        [1, 1, 1],
        [3, 3, 3],
      ]),
    ).toBeNull();
    expect(planeFromNormal([0, 0, 0], [1, 2, 3])).toBeNull();
    expect(planeFromNormal([0, Infinity, 0], [1, 2, 3])).toBeNull();
  });

  it("has the angles that it was made with", () => {
    for (const tilt of [0, 12.5, 45, 90]) {
      for (const azimuth of [-170, -90, 0, 33, 180]) {
        const found = anglesOf(normalOf({ tilt, azimuth }), azimuth);
        expect(found.tilt).toBeCloseTo(tilt, 9);
        expect(found.azimuth).toBeCloseTo(azimuth, 9);
      }
    }
  });

  it("has an exact normal at right angles", () => {
    expect(normalOf({ tilt: 90, azimuth: 90 })).toEqual([0, 1, 0]);
    expect(normalOf({ tilt: 0, azimuth: 77 })).toEqual([0, 0, 1]);
  });

  it("has the same angles as its opposite", () => {
    const normal = normalOf({ tilt: 30, azimuth: 40 });
    const opposite = anglesOf([-normal[0], -normal[1], -normal[2]]);
    expect(opposite.tilt).toBeCloseTo(30, 9);
    expect(opposite.azimuth).toBeCloseTo(40, 9);
  });
});

describe("the bases", () => {
  it("are two directions of length 1 in the plane", () => {
    for (const kind of ["layer", "xz"] as const) {
      for (const normal of [
        [1, 2, -3],
        [0, 0, 1],
        [0, 1, 0],
        [1, 0, 0],
        [-1, 0, 2],
      ] as Vector3[]) {
        const plane = planeFromNormal(normal, [0, 0, 0])!;
        const { p, q } = sectionBasis(kind, plane);
        expect(norm(p)).toBeCloseTo(1, 12);
        expect(norm(q)).toBeCloseTo(1, 12);
        for (const zero of [dot(p, q), dot(p, plane.normal), dot(q, plane.normal)]) {
          expect(zero).toBeCloseTo(0, 12);
        }
      }
    }
  });

  it("tell by how much they were turned", () => {
    const basis = sectionBasis("layer", planeFromNormal([1, 2, -3], [0, 0, 0])!);
    expect(angleFrom(basis, turnedBasis(basis, 37))).toBeCloseTo(37, 9);
    expect(angleFrom(basis, basis)).toBe(0);
  });
});

describe("a rectangle of a plane", () => {
  const rectangle = {
    origin: [10, 20, 30] as Vector3,
    ...sectionBasis("layer", planeFromNormal([1, 2, -3], [0, 0, 0])!),
    width: 4,
    height: 2,
  };

  it("finds its places again", () => {
    const [a, b] = inPlane(rectangle, inSample(rectangle, [1.5, -2]));
    expect(a).toBeCloseTo(1.5, 9);
    expect(b).toBeCloseTo(-2, 9);
  });

  it("cuts off what lies outside", () => {
    const triangle = (
      [
        [-4, 1],
        [2, -5],
        [8, 1],
      ] as const
    ).map((place) => inSample(rectangle, place));
    const clipped = clippedTo(rectangle, triangle).map((point) => inPlane(rectangle, point));
    expect(Math.min(...clipped.map(([a]) => a))).toBeCloseTo(0, 9);
    expect(Math.max(...clipped.map(([a]) => a))).toBeCloseTo(4, 9);
    expect(Math.min(...clipped.map(([, b]) => b))).toBeCloseTo(0, 9);
    expect(Math.max(...clipped.map(([, b]) => b))).toBeCloseTo(1, 9);
  });

  it("leaves what lies inside, and nothing of what lies beside", () => {
    expectNear(clippedTo(rectangle, cornersOf(rectangle)), cornersOf(rectangle));
    const beside = cornersOf({ ...rectangle, origin: inSample(rectangle, [9, 9]) });
    expect(clippedTo(rectangle, beside)).toEqual([]);
  });
});

it("takes the widest triangle, the first of equal ones", () => {
  const square: Vector3[] = [
    [0, 0, 0],
    [9, 0, 0],
    [9, 9, 0],
    [0, 9, 0],
  ];
  expect(widestTriangle(square)).toEqual(square.slice(0, 3));
});

it("turns right-handed, right angles exactly", () => {
  expect(turned([1, 0, 0], [0, 0, 1], 90)).toEqual([0, 1, 0]);
});

it("knows the box and its layers", () => {
  expect(extent(knee)).toEqual([9990, 9990, 1580]);
  expect(layerAt(knee, 0)).toBe(1);
  expect(layerAt(knee, 31)).toBe(3);
  expect(layerAt(knee, 1e9)).toBe(80);
});
