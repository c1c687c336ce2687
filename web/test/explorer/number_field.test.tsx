// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it, vi } from "vitest";

import { NumberField } from "../../src/explorer/NumberField";

const page = document.body.appendChild(document.createElement("div"));
const input = () => page.querySelector("input")!;
const show = (value: number, onChange: (value: number) => boolean | void = () => {}) =>
  act(() => render(<NumberField label="Offset" value={value} onChange={onChange} />, page));
const type = (text: string) =>
  act(() => {
    input().focus();
    input().value = text;
    input().dispatchEvent(new Event("input", { bubbles: true }));
  });
const end = () => act(() => void input().dispatchEvent(new Event("change", { bubbles: true })));

afterEach(() => {
  render(null, page);
});

it("keeps what is being typed while the page shows something new", async () => {
  const take = vi.fn();
  await show(5, take);
  await type("12");
  await show(6, take);
  expect(input().value).toBe("12");
  await end();
  expect(take).toHaveBeenCalledWith(12);
  await show(12, take);
  expect(input().value).toBe("12");
});

it("shows what is the case again when the typing led to nothing", async () => {
  await show(5, () => false);
  await type("-1");
  await end();
  expect(input().value).toBe("5");
  await type("7");
  await act(() => input().blur());
  expect(input().value).toBe("5");
});
