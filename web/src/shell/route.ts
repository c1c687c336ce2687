import { signal } from "@preact/signals";

/** Where the page is: "#/layers/12?zoom=2" is { path: ["layers", "12"], query: { zoom: "2" } }. */
export interface Route {
  path: string[];
  query: URLSearchParams;
}

export function parseHash(hash: string): Route {
  const text = hash.replace(/^#\/?/, "");
  const mark = text.indexOf("?");
  const path = mark < 0 ? text : text.slice(0, mark);
  return {
    path: path.split("/").filter(Boolean).map(decoded),
    query: new URLSearchParams(mark < 0 ? "" : text.slice(mark + 1)),
  };
}

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text; // a lone percent sign means itself
  }
}

export function hashOf(path: (string | number)[], query?: URLSearchParams): string {
  const text = query?.toString();
  return `#/${path.map((part) => encodeURIComponent(part)).join("/")}${text ? `?${text}` : ""}`;
}

let followed = location.hash;
export const route = signal<Route>(parseHash(followed));

const follow = (): void => {
  followed = location.hash;
  route.value = parseHash(followed);
};
window.addEventListener("hashchange", follow);

/** Goes there; "back" comes back. */
export function goTo(hash: string): void {
  location.hash = hash;
}

/**
 * The address of what is shown already: no new entry in the history. Where somebody has just gone
 * elsewhere, which the page is told a moment later, that is kept.
 */
export function replaceHash(hash: string): void {
  if (location.hash !== followed) return follow();
  if (hash === location.hash) return;
  history.replaceState(history.state, "", hash);
  follow();
}
