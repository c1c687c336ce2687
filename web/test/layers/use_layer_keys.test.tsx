// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, expect, it } from "vitest";

import { useLayerKeys } from "../../src/layers/use_layer_keys";

let done: string[];

function Keys({ name }: { name: string }) {
  const note = (what: string) => void done.push(`${name}: ${what}`);
  useLayerKeys({
    step: (by) => note(`step ${by}`),
    page: (by) => note(`page ${by}`),
    first: () => note("first"),
    last: () => note("last"),
    whole: () => note("whole"),
    screen: () => {
      note("screen");
      return null;
    },
  });
  return <input />;
}

const show = (name: string) => act(() => render(<Keys name={name} />, document.body));
const press = (key: string, target: EventTarget = document.body) =>
  target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));

beforeEach(async () => {
  done = [];
  await show("a");
});
afterEach(() => render(null, document.body));

it("acts on keys, and keeps the browser from doing so", () => {
  for (const key of ["ArrowLeft", "PageDown", "Home", "End", "0", "+"]) {
    expect(press(key)).toBe(false);
  }
  expect(done).toEqual(["a: step -1", "a: page 1", "a: first", "a: last", "a: whole", "a: screen"]);
});

it("leaves alone what is typed, and keys that mean nothing", () => {
  expect(press("1", document.querySelector("input")!)).toBe(true);
  expect(press("q")).toBe(true);
  expect(done).toEqual([]);
});

it("acts as was last said, and not at all once it is gone", async () => {
  await show("b");
  press("Home");
  render(null, document.body);
  press("Home");
  expect(done).toEqual(["b: first"]);
});
