import type { PlaneDefinition } from "./plane_state";
import { defaultChoices, thetaText } from "./section_choices";
import type { SectionChoices } from "./section_choices";

/** Parameters of /api/v1/section, named as the tool's options are. */
export type Query = Record<string, string>;

export const planeQuery = (definition: PlaneDefinition): Query =>
  definition.kind === "points"
    ? { points: definition.points.join(" ") }
    : { normal: definition.normal.join(","), through: definition.through.join(",") };

/** What differs from what the tool takes by itself. */
export function choicesQuery(choices: SectionChoices): Query {
  const query: Query = {};
  if (choices.basis !== defaultChoices.basis) query.basis = choices.basis;
  if (choices.theta.kind !== "bounding") query.theta = thetaText(choices.theta);
  if (choices.interpolation !== defaultChoices.interpolation) {
    query.interpolation = choices.interpolation;
  }
  if (choices.background.some((part) => part !== 0)) {
    query.background = choices.background.join(",");
  }
  return query;
}

/** Commas and colons stand as they are: they need no escape in a query, and people read these. */
export function queryText(query: Query): string {
  return new URLSearchParams(query).toString().replace(/%2C/g, ",").replace(/%3A/g, ":");
}
