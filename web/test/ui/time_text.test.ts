import { expect, it } from "vitest";

import { timeText } from "../../src/ui/time_text";

const now = new Date(2026, 10, 27, 18, 0);

it("tells the hour of today, and the day of what was earlier", () => {
  const hour = timeText(new Date(2026, 10, 27, 9, 5).toISOString(), now);
  expect(hour).toMatch(/^at \D*0?9\D05/);
  expect(timeText(new Date(2026, 10, 26, 9, 5).toISOString(), now)).toMatch(/^on .*26.* at /);
  expect(timeText(new Date(2026, 10, 26, 9, 5).toISOString(), now)).not.toContain("2026");
  expect(timeText(new Date(2025, 10, 26, 9, 5).toISOString(), now)).toContain("2025");
});

it("leaves what it cannot read as it is", () => {
  expect(timeText("yesterday", now)).toBe("yesterday");
});
