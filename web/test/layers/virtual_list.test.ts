import { describe, expect, it } from "vitest";

import {
  itemsInSight,
  itemsOfPage,
  length,
  scrollToCentre,
  scrollToShow,
} from "../../src/layers/virtual_list";

const list = { count: 10000, pitch: 100 };

describe("the items in sight", () => {
  it("are those that the window touches", () => {
    expect(itemsInSight(list, 0, 1000)).toEqual({ first: 0, end: 10 });
    expect(itemsInSight(list, 250, 1000)).toEqual({ first: 2, end: 13 });
  });

  it("end with the list", () => {
    expect(itemsInSight(list, 999_500, 1000, 5)).toEqual({ first: 9990, end: 10000 });
    expect(itemsInSight(list, 0, 1000, 5)).toEqual({ first: 0, end: 15 });
  });

  it("are few whatever the length of the list", () => {
    const { first, end } = itemsInSight(list, 543_210, 1440, 3);
    expect(end - first).toBeLessThan(25);
  });

  it("are none of an empty list, nor past its end", () => {
    expect(itemsInSight({ count: 0, pitch: 100 }, 0, 1000)).toEqual({ first: 0, end: 0 });
    expect(itemsInSight(list, 2e6, 1000)).toEqual({ first: 0, end: 0 });
  });
});

describe("the scroll to an item", () => {
  it("stays when the item is in sight", () => {
    expect(scrollToShow(list, 5, 250, 1000)).toBe(250);
  });

  it("goes no farther than needed", () => {
    expect(scrollToShow(list, 1, 250, 1000)).toBe(100);
    expect(scrollToShow(list, 20, 250, 1000)).toBe(1100);
  });

  it("puts the item in the middle, but for the ends", () => {
    expect(scrollToCentre(list, 5000, 1000)).toBe(499_550);
    expect(scrollToCentre(list, 0, 1000)).toBe(0);
    expect(scrollToCentre(list, 9999, 1000)).toBe(length(list) - 1000);
  });

  it("is none for a list shorter than the window", () => {
    expect(scrollToCentre({ count: 3, pitch: 100 }, 2, 1000)).toBe(0);
  });
});

it("passes a page less one item, and at least one", () => {
  expect(itemsOfPage(list, 1050)).toBe(9);
  expect(itemsOfPage(list, 50)).toBe(1);
});
