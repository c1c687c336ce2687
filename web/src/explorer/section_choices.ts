import type { BasisKind } from "./geometry/section_basis";
import type { Vector3 } from "./geometry/vector3";

/** The rectangle that becomes the picture. Micrometres and degrees. */
export type Theta =
  | { kind: "bounding" | "inscribed" | "inscribed-any" }
  | { kind: "edge"; edge: number }
  | { kind: "custom"; corner: Vector3; width: number; height: number; angle: number };

export const interpolations = ["nearest", "linear", "cubic"] as const;
export type Interpolation = (typeof interpolations)[number];
export type Colour = readonly [number, number, number]; // 0 to 255

/** How a section is cut and drawn, apart from its plane. */
export interface SectionChoices {
  basis: BasisKind;
  theta: Theta;
  interpolation: Interpolation;
  background: Colour;
}

/** What the tool takes when it is told nothing. */
export const defaultChoices: SectionChoices = {
  basis: "layer",
  theta: { kind: "bounding" },
  interpolation: "linear",
  background: [0, 0, 0],
};

export function thetaText(theta: Theta): string {
  switch (theta.kind) {
    case "edge":
      return `edge:${theta.edge}`;
    case "custom":
      return `custom:${[...theta.corner, theta.width, theta.height, theta.angle].join(",")}`;
    default:
      return theta.kind;
  }
}

/** None for what the tool would refuse. */
export function parseTheta(text: string): Theta | null {
  if (text === "bounding" || text === "inscribed" || text === "inscribed-any") {
    return { kind: text };
  }
  const [word, rest = ""] = text.split(/:(.*)/s);
  if (word === "edge" && /^[0-5]$/.test(rest)) return { kind: "edge", edge: Number(rest) };
  const values = word === "custom" ? numbers(rest, 6) : null;
  if (!values) return null;
  const [x, y, z, width, height, angle] = values as [
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  if (width <= 0 || height <= 0) return null;
  return { kind: "custom", corner: [x, y, z], width, height, angle };
}

/** So many finite numbers with commas between them. */
export function numbers(text: string, count: number): number[] | null {
  const values = text.split(",").map((part) => (part.trim() === "" ? NaN : Number(part)));
  return values.length === count && values.every(Number.isFinite) ? values : null;
}
