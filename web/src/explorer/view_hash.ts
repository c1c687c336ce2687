import { basisKinds } from "./geometry/section_basis";
import type { Vector3 } from "./geometry/vector3";
import type { PlaneDefinition, ThreePoints } from "./plane_state";
import { defaultChoices, interpolations, numbers, parseTheta } from "./section_choices";
import type { Colour, SectionChoices } from "./section_choices";
import { choicesQuery, planeQuery, queryText } from "./section_query";

/** The part of a section that is looked at closely. */
export interface Closeup {
  middle: Vector3; // micrometres of the sample; put on the plane along its normal
  pixel: number; // micrometres in one pixel of the screen
}

/** All that a link to the explorer holds. */
export interface ExplorerView {
  plane: PlaneDefinition | null; // none: the page chooses
  choices: SectionChoices;
  around: boolean; // the whole section is shown, with the rectangle in it
  closeup: Closeup | null; // none: all of it, as large as it fits
  follow: boolean; // the newest face, whichever that is
}

const digits = 8; // of a close-up: finer than a pixel of the screen

export function viewQuery(view: ExplorerView): string {
  const query = {
    ...(view.plane && !view.follow ? planeQuery(view.plane) : {}),
    ...choicesQuery(view.choices),
  };
  if (view.around) query.around = "1";
  if (view.follow) query.follow = "1";
  if (view.closeup) {
    const numbers = [...view.closeup.middle, view.closeup.pixel];
    query.closeup = numbers.map((value) => Number(value.toPrecision(digits))).join(",");
  }
  return queryText(query);
}

/** What can't be read is left at what it is by default, so that an old or a mistyped link opens. */
export function parseView(text: string): ExplorerView {
  const query = new URLSearchParams(text);
  return {
    plane: parsePlane(query),
    choices: parseChoices(query),
    around: query.get("around") === "1",
    closeup: parseCloseup(query.get("closeup") ?? ""),
    follow: query.get("follow") === "1",
  };
}

const vector = (text: string): Vector3 | null => numbers(text, 3) as Vector3 | null;

function parsePlane(query: URLSearchParams): PlaneDefinition | null {
  const points = (query.get("points") ?? "").trim().split(/\s+/).map(vector);
  if (points.length === 3 && points.every((point) => point !== null)) {
    return { kind: "points", points: points as unknown as ThreePoints };
  }
  const normal = vector(query.get("normal") ?? "");
  const through = vector(query.get("through") ?? "");
  return normal && through ? { kind: "normal", normal, through } : null;
}

function parseChoices(query: URLSearchParams): SectionChoices {
  const oneOf = <T extends string>(names: readonly T[], name: string, otherwise: T): T =>
    names.find((known) => known === query.get(name)) ?? otherwise;
  const colour = numbers(query.get("background") ?? "", 3);
  const isColour = colour?.every((part) => Number.isInteger(part) && part >= 0 && part <= 255);
  return {
    basis: oneOf(basisKinds, "basis", defaultChoices.basis),
    theta: parseTheta(query.get("theta") ?? "") ?? defaultChoices.theta,
    interpolation: oneOf(interpolations, "interpolation", defaultChoices.interpolation),
    background: isColour ? (colour as unknown as Colour) : defaultChoices.background,
  };
}

function parseCloseup(text: string): Closeup | null {
  const values = numbers(text, 4);
  if (!values || values[3] <= 0) return null;
  return { middle: values.slice(0, 3) as unknown as Vector3, pixel: values[3] };
}
