/** How numbers are written for people. A missing one is a dash. */

export const dash = "–";

export type MaybeNumber = number | null | undefined;

const isNumber = (value: MaybeNumber): value is number =>
  typeof value === "number" && Number.isFinite(value);

/** With so many decimals, thousands apart by a narrow space that doesn't break, and a true minus sign. */
export function fixed(value: MaybeNumber, decimals = 0): string {
  if (!isNumber(value)) return dash;
  const text = Math.abs(value).toFixed(decimals);
  const [whole, fraction] = text.split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, "\u202f") : whole;
  const sign = value < 0 && Number(text) !== 0 ? "−" : "";
  return sign + grouped + (fraction ? `.${fraction}` : "");
}

/** With so many digits that count. */
export function significant(value: MaybeNumber, digits = 3): string {
  if (!isNumber(value)) return dash;
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  return fixed(value, Math.min(8, Math.max(0, digits - 1 - magnitude)));
}

/** How many decimals a round number has, such as the step between an axis's lines. */
export const decimalsOf = (step: number): number =>
  Math.min(8, String(Number(step.toPrecision(6))).split(".")[1]?.length ?? 0);

/** Its unit is parted by a space that doesn't break. */
export const withUnit = (text: string, unit: string): string =>
  text === dash ? dash : `${text}\u00a0${unit}`;

export const micrometres = (value: MaybeNumber, decimals = 1): string =>
  withUnit(fixed(value, decimals), "µm");

export const percent = (value: MaybeNumber, decimals = 0): string =>
  withUnit(fixed(value, decimals), "%");

/** 1536 is "1.5 KiB". */
export function bytes(value: MaybeNumber): string {
  if (!isNumber(value)) return dash;
  const units = ["B", "KiB", "MiB", "GiB", "TiB"];
  let size = value;
  let unit = 0;
  while (size >= 1024 && unit + 1 < units.length) {
    size /= 1024;
    unit += 1;
  }
  return withUnit(unit === 0 ? fixed(size) : significant(size, 3), units[unit]);
}
