// @vitest-environment happy-dom
import { expect, it, vi } from "vitest";

import { bringIntoSight } from "../../src/layers/bring_into_sight";

/** An element from `top` to `bottom` of a window of 800 pixels, whose bars cover the first 100. */
function scrolledTo(top: number, bottom: number): boolean {
  window.innerHeight = 800;
  document.body.innerHTML = '<div class="bars"></div><div id="stage"></div>';
  const [bars, stage] = document.body.children as unknown as [HTMLElement, HTMLElement];
  bars.getBoundingClientRect = () => new DOMRect(0, 0, 400, 100);
  stage.getBoundingClientRect = () => new DOMRect(0, top, 400, bottom - top);
  stage.scrollIntoView = vi.fn();
  bringIntoSight(stage);
  return vi.mocked(stage.scrollIntoView).mock.calls.length > 0;
}

it("leaves alone what is seen", () => {
  expect(scrolledTo(100, 700)).toBe(false);
  expect(scrolledTo(-100, 500)).toBe(false);
});

it("scrolls to what is above, below, or behind the bars", () => {
  expect(scrolledTo(-900, -300)).toBe(true);
  expect(scrolledTo(700, 1300)).toBe(true);
  expect(scrolledTo(-350, 250)).toBe(true);
});
