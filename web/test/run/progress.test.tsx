// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, expect, it } from "vitest";

import type { LastAttempt } from "../../src/api/types";
import { Progress } from "../../src/run/Progress";
import { aStatus } from "../a_status";

const page = document.createElement("div");
const rejection = () => page.querySelector('[data-role="last-rejection"]')?.textContent ?? null;

function show(changes: Partial<LastAttempt> | null): void {
  const last: LastAttempt | null = changes && {
    id: 0,
    layer: 3,
    attempt: 1,
    verdict: "rejected",
    slug: "darker",
    reason: "the light is −0.4",
    ...changes,
  };
  void act(() => render(<Progress status={aStatus({ layer: 3, last_attempt: last })} />, page));
}

afterEach(() => render(null, page));

it("says why the layer at hand needs another photograph", () => {
  show({});
  expect(rejection()).toBe("Attempt 1 was rejected: the light is −0.4.");
});

it("says nothing of a photograph that was accepted, or is of another layer", () => {
  for (const changes of [null, { verdict: "accepted" }, { layer: 2 }]) {
    show(changes);
    expect(rejection()).toBeNull();
  }
});
