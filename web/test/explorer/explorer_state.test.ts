import { beforeEach, describe, expect, it } from "vitest";

import type { Sample } from "../../src/api/types";
import { ExplorerState } from "../../src/explorer/explorer_state";
import { movePoint, nudge, toLayer, turn } from "../../src/explorer/plane_moves";
import { placePlane } from "../../src/explorer/plane_state";
import type { SectionPicture, SectionRecord } from "../../src/explorer/section_record";
import { parseView, viewQuery } from "../../src/explorer/view_hash";

const knee = {
  name: "knee",
  size: [1000, 1000, 80],
  spacing_um: [10, 10, 20],
  layers_present: 40,
  generation: 7,
} as unknown as Sample;

let state: ExplorerState;
beforeEach(() => {
  state = new ExplorerState();
  state.panel.value = { width: 1000, height: 700, ratio: 1 };
  state.learn(knee);
});

const asked = (address: string) => new URL(address, "http://rig").searchParams;
const sharp = () => asked(state.wish.value!.sharp.address);
const preview = () => asked(state.wish.value!.preview!.address);

const picture = (changed: Partial<SectionPicture>, record: Partial<SectionRecord> = {}) =>
  ({
    image: { close() {} },
    sharp: true,
    whole: true,
    ...changed,
    record: {
      polygon_um: [],
      rectangle: {
        origin_um: [0, 0, 0],
        p: [1, 0, 0],
        q: [0, 1, 0],
        width_um: 9990,
        height_um: 99,
      },
      pixel_um: 12,
      full: { pixel_um: 10, width: 1000, height: 10 },
      ...record,
    },
  }) as unknown as SectionPicture;

describe("what is asked of the server", () => {
  it("is the plane, a quick picture first, then one as large as the panel", () => {
    expect(preview().get("format")).toBe("jpeg");
    expect(preview().get("fit")).toBe("640x448");
    expect(sharp().get("format")).toBe("png");
    expect(sharp().get("fit")).toBe("1000x700");
    expect(sharp().get("points")).toBe("0,0,0 9990,0,0 9990,9990,780");
  });

  it("has the chosen rectangle, basis, interpolation and background", () => {
    state.choose({
      theta: { kind: "inscribed" },
      basis: "xz",
      interpolation: "cubic",
      background: [1, 2, 3],
    });
    expect(sharp().get("theta")).toBe("inscribed");
    expect(sharp().get("basis")).toBe("xz");
    expect(sharp().get("interpolation")).toBe("cubic");
    expect(sharp().get("background")).toBe("1,2,3");
    state.around.value = true;
    expect(sharp().get("theta")).toBeNull();
  });

  it("is a part at a finer pixel in a close-up, never finer than a voxel", () => {
    toLayer(state, 1);
    state.closeup.value = { middle: [5000, 5000, 0], pixel: 12 };
    expect(sharp().get("pixel")).toBe("12");
    expect(sharp().get("theta")).toMatch(/^custom:/);
    expect(sharp().get("fit")).toBeNull();
    expect(preview().get("pixel")).toBe("30");
    state.closeup.value = { middle: [5000, 5000, 0], pixel: 2 };
    expect(sharp().get("pixel")).toBeNull();
    expect(sharp().get("theta")).toBe("custom:4000,4300,0,2000,1400,0");
  });

  it("is asked anew when the sample has grown", () => {
    const before = state.wish.value!.sharp.address;
    state.grow({ layers_present: 41, generation: 8 });
    expect(state.wish.value!.sharp.address).not.toBe(before);
  });
});

describe("the plane", () => {
  it("follows the newest face until it is moved", () => {
    state.toNewest();
    expect(state.placed.value!.offset).toBe(780);
    state.grow({ layers_present: 41, generation: 8 });
    expect(state.placed.value!.offset).toBe(800);
    nudge(state, -1);
    state.grow({ layers_present: 42, generation: 9 });
    expect(state.placed.value!.offset).toBe(780);
    expect(state.follow.value).toBe(false);
  });

  it("stays where points on a line would be none", () => {
    const before = state.definition.value;
    const [first] = state.placed.value!.points;
    expect(movePoint(state, 1, first)).toBe(false);
    expect(state.definition.value).toBe(before);
  });

  it("keeps the azimuth while its tilt goes through zero", () => {
    turn(state, { tilt: 30, azimuth: 50 });
    turn(state, { tilt: 0 });
    turn(state, { tilt: 20 });
    expect(state.placed.value!.angles.azimuth).toBeCloseTo(50, 3);
  });

  it("of a link is shown, and its link is the same", () => {
    const query = "normal=1,0,0&through=10,20,30&theta=custom:0,0,0,100,100,0&around=1";
    state.open(parseView(query));
    expect(viewQuery(state.view.value)).toBe(query);
    expect(state.placed.value!.angles.tilt).toBeCloseTo(90, 9);
  });

  it("of a link that can't be read is the page's own", () => {
    state.open(parseView("points=1,1,1 1,1,1 1,1,1"));
    expect(state.placed.value!.polygon.length).toBe(4);
  });
});

describe("a close-up", () => {
  it("stays while the plane moves, unless what it saw may be outside", () => {
    state.closeup.value = { middle: [5000, 5000, 0], pixel: 5 };
    nudge(state, 1);
    expect(state.closeup.value).not.toBeNull();
    state.choose({ theta: { kind: "inscribed" } });
    expect(state.closeup.value).toBeNull();
  });
});

describe("while a frame of a series is shown", () => {
  const layer21 = "normal=0,0,1&through=4995,4995,400";
  beforeEach(() => {
    state.open(parseView("normal=0,1,0&through=0,5000,0&closeup=10,5000,30,5&around=1"));
    const placed = placePlane(parseView(layer21).plane!, state.cuboid.value!)!;
    state.frame.value = { picture: picture({}), placed, pixel: 12 };
  });

  it("the section that is exported is the one in its plane", () => {
    expect(state.shownQuery.value).toEqual({ normal: "0,0,1", through: "4995,4995,400" });
  });

  it("a link opens the section in its plane, all of it", () => {
    expect(viewQuery(state.shownView.value)).toBe(layer21);
  });

  it("the plane from before the series is kept, to come back to", () => {
    expect(state.query.value).toMatchObject({ normal: "0,1,0" });
    state.frame.value = null;
    expect(state.shownView.value).toBe(state.view.value);
    expect(state.shownQuery.value).toEqual(state.query.value);
  });
});

describe("a picture that has come", () => {
  it("is shown with its pixels on the screen's", () => {
    state.show(picture({}), "a");
    expect(state.window.value!.pixel).toBe(12);
    expect(state.settled.value).toBe(true);
  });

  it("that is a preview fills the panel and is not the last word", () => {
    state.show(picture({ sharp: false }, { pixel_um: 25 }), "a");
    expect(state.window.value!.pixel).toBeCloseTo(10, 1);
    expect(state.settled.value).toBe(false);
  });

  it("tells where an inscribed rectangle lies", () => {
    state.choose({ theta: { kind: "inscribed" } });
    expect(state.rectangle.value).toBeNull();
    state.show(picture({}), JSON.stringify(state.query.value));
    expect(state.rectangle.value!.width).toBe(9990);
  });

  it("tells what of the sample is under the pointer, and nothing beside it", () => {
    const record = {
      picture: { width: 800, height: 9 },
      pixel_to_sample: [
        [12, 0, 0],
        [0, 12, 0],
        [0, 0, 40],
      ],
    } as Partial<SectionRecord>;
    state.show(picture({}, record), "a");
    const { left, top } = state.placement.value!;
    const under = state.sampleUnder([left + 100.5, top + 2.5])!;
    [1200, 24, 40].forEach((value, i) => expect(under[i]).toBeCloseTo(value, 9));
    expect(state.sampleUnder([left - 1, top + 2.5])).toBeNull();
  });

  it("takes the place of the one before, whose memory is given back", () => {
    let closed = 0;
    const image = { close: () => (closed += 1) } as unknown as ImageBitmap;
    state.show(picture({ image }), "a");
    state.show(picture({}), "a");
    expect(closed).toBe(1);
  });
});
