// @vitest-environment happy-dom
import { expect, it } from "vitest";

import { replaceHash, route } from "../../src/shell/route";

it("is where the address says", () => {
  replaceHash("#/layers/3?zoom=2");
  expect(route.value.path).toEqual(["layers", "3"]);
  expect(location.hash).toBe("#/layers/3?zoom=2");
});

it("keeps where somebody has just gone, of which the page was not told yet", () => {
  replaceHash("#/layers/3");
  history.pushState(null, "", "#/explorer"); // as by a link, before its hashchange
  replaceHash("#/layers/3?zoom=2");
  expect(location.hash).toBe("#/explorer");
  expect(route.value.path).toEqual(["explorer"]);
});
