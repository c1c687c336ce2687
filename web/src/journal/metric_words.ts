import { capital } from "../shell/capital";
import { dash, fixed, micrometres, significant, withUnit } from "../ui/numbers";

/** Metrics of a frame as a person reads them; what each of them is: docs/quality.md. */

/** How a value is held against its limit. */
export type Bound = "least" | "most" | "within" | "none" | "unknown";
type Unit = "ratio" | "part" | "pixels" | "micrometres" | "energy";

export interface MetricWords {
  readonly title: string;
  readonly bound: Bound;
  readonly unit: Unit;
}

/** What noise adds to a band of detail, without light and by light. */
const noiseOf = (band: string, title: string): [string, MetricWords][] => [
  [
    `noise_${band}_dark`,
    { title: `Noise of ${title}, without light`, bound: "none", unit: "energy" },
  ],
  [`noise_${band}_light`, { title: `Noise of ${title}, by light`, bound: "none", unit: "energy" }],
];

const known = new Map<string, MetricWords>([
  ...Object.entries<MetricWords>({
    sharpness_ratio: { title: "Sharpness", bound: "least", unit: "ratio" },
    sharpness_along_axis: {
      title: "Sharpness along the weaker axis",
      bound: "least",
      unit: "ratio",
    },
    fine_contrast: { title: "Contrast of fine detail", bound: "least", unit: "ratio" },
    sharpness_to_record: {
      title: "Sharpness against the last layers",
      bound: "least",
      unit: "ratio",
    },
    blurred_part: { title: "Blurred part", bound: "most", unit: "part" },
    brightness_minimum: { title: "Mean brightness, not too dark", bound: "least", unit: "part" },
    brightness_maximum: { title: "Mean brightness, not too bright", bound: "most", unit: "part" },
    clipped_fraction: { title: "Overexposed part", bound: "most", unit: "part" },
    shift: { title: "Shift of the block", bound: "most", unit: "pixels" },
    shift_x: { title: "Shift to the right", bound: "within", unit: "pixels" },
    shift_y: { title: "Shift downwards", bound: "within", unit: "pixels" },
    glare: { title: "Glare", bound: "most", unit: "part" },
    frost: { title: "Frost", bound: "most", unit: "part" },
    shade: { title: "Shaded part", bound: "most", unit: "part" },
    debris: { title: "Debris", bound: "most", unit: "part" },
    colour_cast: { title: "Colour cast of the light", bound: "most", unit: "part" },
    brightness: { title: "Change of the light", bound: "within", unit: "part" },
    evenness: { title: "Unevenness of the light", bound: "most", unit: "part" },
    casting_red: { title: "Casting material, red", bound: "none", unit: "part" },
    casting_green: { title: "Casting material, green", bound: "none", unit: "part" },
    casting_blue: { title: "Casting material, blue", bound: "none", unit: "part" },
    brightness_drift: { title: "Light since the first layer", bound: "within", unit: "part" },
    colour_drift: { title: "Colour since the first layer", bound: "most", unit: "part" },
    face_change: { title: "Change from the layer before", bound: "least", unit: "part" },
    old_part: { title: "Part still showing the layer before", bound: "most", unit: "part" },
    repeated_rows: { title: "Rows repeated from an earlier frame", bound: "most", unit: "part" },
    focus_change: { title: "Change of the focus, a layer", bound: "within", unit: "micrometres" },
    dead_rows: { title: "Rows without a picture", bound: "most", unit: "part" },
  }),
  ...noiseOf("curvature", "the curvature"),
  ...noiseOf("fine", "the gradient"),
  ...noiseOf("middle", "the gradient at half the resolution"),
  ...noiseOf("coarse", "the gradient at a quarter"),
  ...noiseOf("face", "the face's print"),
]);

/** Of a metric that this page does not know: its name, and its numbers as they are. */
export function metricWords(name: string): MetricWords {
  const title = capital(name.replaceAll("_", " "));
  return known.get(name) ?? { title, bound: "unknown", unit: "ratio" };
}

/** Where a metric stands among others; those that are not known come last. */
export function metricOrder(name: string): number {
  const place = [...known.keys()].indexOf(name);
  return place < 0 ? known.size : place;
}

/** "98.7 %", "0.991", "1.52 px". */
export function valueText(value: number | null, words: MetricWords): string {
  switch (words.unit) {
    case "part":
      return withUnit(share(value), "%");
    case "pixels":
      return withUnit(fixed(value, 2), "px");
    case "micrometres":
      return micrometres(value, 1);
    case "energy":
      return significant(value, 2);
    case "ratio":
      return fixed(value, 3);
  }
}

/** In hundredths: two decimals, fewer of what is large, one figure of what is smaller still. */
function share(value: number | null): string {
  if (value === null) return dash;
  const size = Math.abs(value * 100);
  if (size >= 10) return fixed(value * 100, 1);
  return size >= 0.005 ? fixed(value * 100, 2) : significant(value * 100, 1);
}

const boundWords: Readonly<Record<Exclude<Bound, "none">, string>> = {
  least: "≥\u00a0",
  most: "≤\u00a0",
  within: "±\u00a0",
  unknown: "",
};

/** "≤ 0.25 %"; a metric that is only noted has no limit. */
export function limitText(limit: number | null, words: MetricWords): string {
  if (limit === null || words.bound === "none") return "none";
  return boundWords[words.bound] + valueText(limit, words);
}
