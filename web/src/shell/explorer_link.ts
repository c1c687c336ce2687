import { signal } from "@preact/signals";

export const linkOf = (query: string): string => (query ? `#/explorer?${query}` : "#/explorer");

/** The explorer as it was last seen: who looks at another view comes back to it. */
export const seenInExplorer = signal(linkOf(""));
