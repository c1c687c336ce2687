import { signal } from "@preact/signals";

const query = window.matchMedia("(prefers-color-scheme: dark)");

/** Whether the page is dark: what has its colours from the page is drawn anew when that changes. */
export const isDark = signal(query.matches);

query.addEventListener("change", () => {
  isDark.value = query.matches;
});
