import { beforeEach, describe, expect, it } from "vitest";

import { ExplorerState } from "../../src/explorer/explorer_state";
import { defaultExport, orderOf } from "../../src/explorer/export_order";
import { placePlane } from "../../src/explorer/plane_state";
import type { SectionPicture } from "../../src/explorer/section_record";
import { defaultSeries } from "../../src/explorer/series_choice";
import { aSample } from "./a_sample";

describe("what is ordered", () => {
  let state: ExplorerState;
  beforeEach(() => {
    state = new ExplorerState();
    state.learn(aSample);
    state.choose({ interpolation: "cubic" });
  });

  it("is the section at full resolution, unless a pixel was typed", () => {
    expect(orderOf(state, defaultSeries, defaultExport)).toEqual({
      kind: "section",
      format: "png",
      parameters: { points: "0,0,0 9990,0,0 9990,9990,1580", interpolation: "cubic" },
      movie: false,
      frames: true,
    });
    const coarse = orderOf(state, defaultSeries, { ...defaultExport, pixel: 25 });
    expect(coarse?.parameters.pixel).toBe("25");
  });

  it("is the section in the plane that is shown while a series plays", () => {
    const definition = { kind: "normal", normal: [0, 0, 1], through: [0, 0, 400] } as const;
    const placed = placePlane(definition, state.cuboid.value!)!;
    const picture = {} as SectionPicture;
    state.frame.value = { picture, placed, pixel: 10 };
    const order = orderOf(state, defaultSeries, defaultExport);
    expect(order?.parameters).toMatchObject({ normal: "0,0,1", through: "4995,4995,400" });
    const series = orderOf(state, defaultSeries, { ...defaultExport, kind: "series" });
    expect(series?.series?.normal).not.toBe("0,0,1"); // it goes on from where it began
  });

  it("is a series drawn as the section is, from its plane on", () => {
    const order = orderOf(state, defaultSeries, { ...defaultExport, kind: "series", rate: 10 });
    expect(order?.parameters).toEqual({ interpolation: "cubic" });
    expect(order?.series).toMatchObject({ kind: "rotate", axis: "x", step: "3" });
    expect(order).toMatchObject({ movie: true, frames: true, rate: 10 });
  });

  it("is nothing where there is nothing to write", () => {
    const neither = { ...defaultExport, kind: "series", movie: false, frames: false } as const;
    expect(orderOf(state, defaultSeries, neither)).toBeNull();
    expect(orderOf(new ExplorerState(), defaultSeries, defaultExport)).toBeNull();
  });
});
