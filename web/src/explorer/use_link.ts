import { effect, untracked } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { linkOf, seenInExplorer } from "../shell/explorer_link";
import { replaceHash, route } from "../shell/route";
import type { ExplorerState } from "./explorer_state";
import { parseView, viewQuery } from "./view_hash";

const rest_ms = 250;

/**
 * The address holds the view: it follows the hand, and whoever changes it changes the view. An
 * address that names none is of the view that was seen last.
 */
export function useLink(state: ExplorerState): void {
  useEffect(() => {
    let written: string | null = null;
    let timer: ReturnType<typeof setTimeout> | undefined;
    if (!route.peek().query.toString()) replaceHash(seenInExplorer.peek());
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
      seenInExplorer.value = linkOf(text);
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
