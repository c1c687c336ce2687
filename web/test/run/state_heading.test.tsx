// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it } from "vitest";

import type { Alarm, Status } from "../../src/api/types";
import { StateHeading } from "../../src/run/StateHeading";
import { aStatus } from "../a_status";

const page = document.createElement("div");
const waiting = () => page.querySelector('[data-role="waiting-for"]')?.textContent;

function show(changes: Partial<Status>): void {
  void act(() => render(<StateHeading status={aStatus(changes)} />, page));
}

afterEach(() => render(null, page));

it("says what a step waits for", () => {
  show({ state: "grinding", waiting_for: "waits for the wheel to pass over the block" });
  expect(waiting()).toBe("Waits for the wheel to pass over the block.");
});

it("leaves to the alarm's bar why the alarm can't be acknowledged yet", () => {
  const alarm: Alarm = {
    cause: "the door is open",
    kind: "door",
    advice: "Close the door, then acknowledge.",
    since: "2026-11-20T10:00:00Z",
    state: "grinding",
  };
  const waiting_for = "waits for an operator to acknowledge";
  show({ state: "faulted", alarm, waiting_for, commands: ["acknowledge"] });
  expect(waiting()).toBe("Waits for an operator to acknowledge.");
  show({ state: "faulted", alarm, waiting_for, commands: [] });
  expect(waiting()).toBe("");
});
