import { describe, expect, it } from "vitest";

import {
  depthText,
  fromSample,
  placeDecimals,
  toSample,
  viewFromLink,
  viewToLink,
} from "../../src/layers/sample_place";

const pixel = { x: 10, y: 5 };

describe("places of the sample", () => {
  it("begin at the centre of the first pixel", () => {
    expect(toSample({ x: 0.5, y: 0.5 }, pixel)).toEqual({ x: 0, y: 0 });
    expect(toSample({ x: 3.5, y: 3.5 }, pixel)).toEqual({ x: 30, y: 15 });
    expect(fromSample({ x: 30, y: 15 }, pixel)).toEqual({ x: 3.5, y: 3.5 });
  });

  it("are told to a tenth of a pixel", () => {
    expect(placeDecimals({ x: 10, y: 10 })).toBe(0);
    expect(placeDecimals({ x: 5, y: 5 })).toBe(1);
    expect(placeDecimals({ x: 0.32, y: 1 })).toBe(2);
    expect(placeDecimals({ x: 100, y: 100 })).toBe(0);
  });
});

it("tells the depth of a layer without decimals that mean nothing", () => {
  expect(depthText(1, 20)).toBe("0\u00a0µm");
  expect(depthText(81, 20)).toBe("1600\u00a0µm");
  expect(depthText(4, 12.5)).toBe("37.50\u00a0µm");
});

describe("a link to a view", () => {
  it("gives the view back", () => {
    const view = { x: 1200.5, y: 733.5, scale: 0.75 };
    const link = viewToLink(view, pixel);
    expect(link.get("at")).toBe("12000.0,3665.0");
    expect(viewFromLink(link, pixel)).toEqual(view);
  });

  it.each([
    ["", "nothing"],
    ["at=1,2", "no scale"],
    ["at=1&zoom=1", "half a place"],
    ["at=1,2,3&zoom=1", "too many numbers"],
    ["at=,2&zoom=1", "an empty number"],
    ["at=a,2&zoom=1", "a word"],
    ["at=1,2&zoom=0", "no size"],
    ["at=1,2&zoom=-1", "a negative size"],
    ["at=1,Infinity&zoom=1", "a place nowhere"],
  ])('is none with "%s": %s', (text) => {
    expect(viewFromLink(new URLSearchParams(text), pixel)).toBeNull();
  });
});
