import { effect, untracked } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { replaceHash, route } from "../shell/route";
import type { ExplorerState } from "./explorer_state";
import { parseView, viewQuery } from "./view_hash";

const rest_ms = 250;

export const linkOf = (query: string): string => (query ? `#/explorer?${query}` : "#/explorer");

/** The address holds the view: it follows the hand, and whoever changes it changes the view. */
export function useLink(state: ExplorerState): void {
  useEffect(() => {
    let written: string | null = null;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const stopReading = effect(() => {
      const { path, query } = route.value;
      if (path[0] !== "explorer") return;
      const text = viewQuery(parseView(query.toString()));
      if (text === written) return;
      written = text;
      untracked(() => state.open(parseView(text)));
    });
    const stopWriting = effect(() => {
      const text = viewQuery(state.view.value);
      clearTimeout(timer);
      if (text === written) return;
      timer = setTimeout(() => {
        if (route.peek().path[0] !== "explorer") return;
        written = text;
        replaceHash(linkOf(text));
      }, rest_ms);
    });
    return () => {
      stopReading();
      stopWriting();
      clearTimeout(timer);
    };
  }, []);
}
