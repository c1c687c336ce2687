// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { expect, it, vi } from "vitest";

import { Dialog } from "../../src/ui/Dialog";

it("closes when something beside it is pressed, and not for its own scrollbar", async () => {
  const close = vi.fn();
  const root = document.body.appendChild(document.createElement("div"));
  await act(() =>
    render(
      <Dialog title="Export" onClose={close}>
        <p>Much</p>
      </Dialog>,
      root,
    ),
  );
  const dialog = root.querySelector("dialog") as HTMLDialogElement;
  dialog.getBoundingClientRect = () => new DOMRect(100, 50, 400, 300);
  const press = (clientX: number, clientY: number) =>
    dialog.dispatchEvent(new MouseEvent("mousedown", { clientX, clientY, bubbles: true }));
  press(495, 200);
  expect(close).not.toHaveBeenCalled();
  press(505, 200);
  press(200, 40);
  expect(close).toHaveBeenCalledTimes(2);
});
