import { describe, expect, it } from "vitest";

import { bytes, decimalsOf, fixed, micrometres, percent, significant } from "../../src/ui/numbers";

describe("numbers for people", () => {
  it("have a true minus sign and grouped thousands", () => {
    expect(fixed(-20.44, 1)).toBe("−20.4");
    expect(fixed(9999)).toBe("9999");
    expect(fixed(1234567.891, 2)).toBe("1\u202f234\u202f567.89");
    expect(fixed(-0.001, 1)).toBe("0.0");
  });

  it("are a dash when they are missing", () => {
    for (const missing of [null, undefined, Number.NaN, Infinity]) {
      expect(fixed(missing)).toBe("–");
      expect(micrometres(missing)).toBe("–");
    }
  });

  it("have their unit behind a space that does not break", () => {
    expect(micrometres(12.34)).toBe("12.3\u00a0µm");
    expect(percent(34)).toBe("34\u00a0%");
  });

  it("have as many digits as count", () => {
    expect(significant(0.012345)).toBe("0.0123");
    expect(significant(123.456)).toBe("123");
    expect(significant(0)).toBe("0");
  });

  it("count bytes", () => {
    expect(bytes(512)).toBe("512\u00a0B");
    expect(bytes(1536)).toBe("1.50\u00a0KiB");
    expect(bytes(3 * 1024 ** 3)).toBe("3.00\u00a0GiB");
  });

  it("have no more decimals than a step needs", () => {
    expect([decimalsOf(10), decimalsOf(0.5), decimalsOf(0.05), decimalsOf(0.1 + 0.2)]).toEqual([
      0, 1, 2, 1,
    ]);
  });
});
