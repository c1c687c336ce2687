// @vitest-environment happy-dom
import { render } from "preact";
import { expect, it } from "vitest";

import { MetricTable } from "../../src/layers/MetricTable";

it("does not say that what is only noted has passed", () => {
  const page = document.createElement("div");
  const metrics = [
    { name: "casting_red", value: 0.4, limit: null, passed: true },
    { name: "glare", value: 0.1, limit: 0.2, passed: true },
  ];
  render(<MetricTable metrics={metrics} />, page);
  const rows = [...page.querySelectorAll("tbody tr")].map((row) => row.lastChild?.textContent);
  expect(rows).toContain("–");
  expect(rows).toContain("yes");
});
