import { describe, expect, it } from "vitest";

import type { Cuboid } from "../../src/explorer/geometry/cuboid";
import { dot } from "../../src/explorer/geometry/vector3";
import { alongLayers, alongXz, placePlane } from "../../src/explorer/plane_state";
import {
  defaultSeries,
  frameBasis,
  framePixel,
  seriesQuery,
  wayStep,
} from "../../src/explorer/series_choice";
import type { SeriesFrame } from "../../src/explorer/series_choice";

const knee: Cuboid = { size: [1000, 1000, 80], spacing: [10, 10, 20] };
const layer = placePlane(alongLayers(knee, 10), knee)!;

const frame = (index: number, value: number, normal: [number, number, number]): SeriesFrame => ({
  index,
  value,
  label: "",
  cuts: true,
  plane: { normal, offset_um: -dot(normal, [4995, 4995, 790]) },
});

describe("a series", () => {
  it("turns the plane that is shown", () => {
    expect(seriesQuery({ ...defaultSeries, axis: "y" }, layer, knee)).toEqual({
      kind: "rotate",
      axis: "y",
      through: "4995,4995,180",
      normal: "0,0,1",
      from: "0",
      to: "180",
      step: "3",
    });
  });

  it("moves it by whole voxels through the block, in some sixty frames", () => {
    const along = placePlane(alongXz([0, 100, 0]), knee)!;
    const choice = { ...defaultSeries, kind: "translate" as const };
    expect(wayStep(choice, along, knee)).toBe(170);
    expect(seriesQuery(choice, layer, knee)).toEqual({
      kind: "translate",
      normal: "0,0,1",
      step: "40",
    });
  });

  it("turns its pictures with the planes, so that none flips", () => {
    const first = frame(0, 0, [0, 0, 1]);
    const upright = frame(1, 90, [0, -1, 0]);
    const basis = frameBasis(defaultSeries, "layer", first, upright);
    expect(basis.p).toEqual([1, 0, 0]);
    expect(basis.q).toEqual([0, 0, 1]);
  });

  it("has one pixel, with which its largest frame fits", () => {
    const frames = [frame(0, 0, [0, 0, 1]), frame(1, 90, [0, -1, 0])];
    const pixel = framePixel(defaultSeries, "layer", frames, knee, 1000, 1000);
    expect(pixel).toBeGreaterThanOrEqual(10);
    expect(pixel).toBeLessThan(10.01);
  });
});
