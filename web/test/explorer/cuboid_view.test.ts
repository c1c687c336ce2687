import { describe, expect, it } from "vitest";

import { crossings, surfacePoint } from "../../src/explorer/box_surface";
import { cross, dot, norm, scale, subtract } from "../../src/explorer/geometry/vector3";
import type { Vector3 } from "../../src/explorer/geometry/vector3";
import {
  orbited,
  projected,
  projectionOf,
  screenAxes,
  startingCamera,
  unprojected,
  zoomed,
} from "../../src/explorer/orbit_camera";

const far: Vector3 = [100, 80, 20];

describe("the camera", () => {
  it("has right-handed axes of length 1 from everywhere", () => {
    for (const azimuth of [-120, 0, 28, 90]) {
      for (const elevation of [-90, 0, 32, 90]) {
        const { right, up, towards } = screenAxes({ azimuth, elevation, zoom: 1 });
        expect(norm(subtract(cross(right, up), towards))).toBeCloseTo(0, 12);
        expect(norm(right)).toBeCloseTo(1, 12);
        expect(dot(right, up)).toBeCloseTo(0, 12);
      }
    }
  });

  it("sees the front face from above as the rig's camera does", () => {
    const view = projectionOf({ azimuth: 0, elevation: 90, zoom: 1 }, far, 400, 300);
    const [x0, y0] = projected(view, [0, 0, 0]);
    const [x1, y1] = projected(view, [100, 80, 0]);
    expect(x1).toBeGreaterThan(x0);
    expect(y1).toBeGreaterThan(y0);
    expect(screenAxes({ azimuth: 0, elevation: 90, zoom: 1 }).towards[2]).toBe(-1);
  });

  it("has the front face on top", () => {
    const view = projectionOf(startingCamera, far, 400, 300);
    expect(projected(view, [50, 40, 0])[1]).toBeLessThan(projected(view, [50, 40, 20])[1]);
  });

  it("finds a pixel's place again", () => {
    const view = projectionOf(startingCamera, far, 400, 300);
    const [x, y] = projected(view, unprojected(view, [33, 44]));
    expect(x).toBeCloseTo(33, 9);
    expect(y).toBeCloseTo(44, 9);
  });

  it("stays within its limits", () => {
    expect(orbited(startingCamera, 400, 300)).toMatchObject({ azimuth: 68, elevation: 90 });
    expect(zoomed(startingCamera, 1e9).zoom).toBe(20);
  });
});

describe("a line of sight", () => {
  it("enters the box and leaves it", () => {
    const hit = crossings([50, 40, -500], [0, 0, 1], far)!;
    expect(hit).toEqual([
      [50, 40, 0],
      [50, 40, 20],
    ]);
    expect(crossings([500, 40, -500], [0, 0, 1], far)).toBeNull();
  });

  it("moves a point on the side on which it is", () => {
    expect(surfacePoint([50, 40, -500], [0, 0, 1], far, [0, 0, 0])).toEqual([50, 40, 0]);
    expect(surfacePoint([50, 40, -500], [0, 0, 1], far, [0, 0, 20])).toEqual([50, 40, 20]);
  });

  it("beside the box takes the point to its nearest edge", () => {
    const view = projectionOf(startingCamera, far, 400, 300);
    const start = unprojected(view, [399, 150]);
    const point = surfacePoint(start, scale(-1, view.axes.towards), far, [0, 0, 0]);
    const seen = projected(view, point);
    for (const x of [0, 100]) {
      for (const y of [0, 80]) {
        for (const z of [0, 20]) {
          const corner = projected(view, [x, y, z]);
          const distance = Math.hypot(corner[0] - 399, corner[1] - 150);
          expect(Math.hypot(seen[0] - 399, seen[1] - 150)).toBeLessThanOrEqual(distance + 1e-6);
        }
      }
    }
  });
});
