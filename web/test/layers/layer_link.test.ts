// @vitest-environment happy-dom
import { expect, it } from "vitest";

import { parseHash } from "../../src/shell/route";
import { layerHash, layerLink } from "../../src/layers/layer_link";

it.each([
  ["#/layers", null, null],
  ["#/layers/12", 12, null],
  ["#/layers/12?attempt=3", 12, 3],
  ["#/layers/0", null, null],
  ["#/layers/-4", null, null],
  ["#/layers/1e3", null, null],
  ["#/layers/twelve?attempt=x", null, null],
])("%s names layer %s, attempt %s", (hash, layer, attempt) => {
  expect(layerLink(parseHash(hash))).toEqual({ layer, attempt });
});

it("keeps what part of the picture is seen, and nothing else", () => {
  const query = new URLSearchParams("at=1,2&zoom=3&attempt=9&other=1");
  expect(layerHash({ layer: 5, attempt: null }, query)).toBe("#/layers/5?at=1%2C2&zoom=3");
  expect(layerHash({ layer: 5, attempt: 2 })).toBe("#/layers/5?attempt=2");
  expect(layerHash({ layer: null, attempt: null })).toBe("#/layers");
});
