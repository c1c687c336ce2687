import { hashOf } from "../shell/route";
import type { Route } from "../shell/route";

/** What a link into this view names. */
export interface LayerLink {
  /** null: the newest layer, whichever that is. */
  readonly layer: number | null;
  /** The attempt to look at; null: the one that was accepted. */
  readonly attempt: number | null;
}

export function layerLink(route: Route): LayerLink {
  return {
    layer: wholeNumber(route.path[1]),
    attempt: wholeNumber(route.query.get("attempt") ?? undefined),
  };
}

function wholeNumber(text: string | undefined): number | null {
  return text !== undefined && /^[1-9]\d{0,5}$/.test(text) ? Number(text) : null;
}

/** The address of a layer; what part of it is seen stays as `query` has it. */
export function layerHash(link: LayerLink, query?: URLSearchParams): string {
  const kept = new URLSearchParams();
  for (const name of ["at", "zoom"]) {
    const value = query?.get(name);
    if (value) kept.set(name, value);
  }
  if (link.attempt !== null) kept.set("attempt", String(link.attempt));
  return hashOf(link.layer === null ? ["layers"] : ["layers", link.layer], kept);
}
