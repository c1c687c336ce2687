import { effect, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { hashOf, replaceHash, route } from "../shell/route";
import { viewFromLink, viewToLink, type PixelSize } from "./sample_place";
import type { Viewport } from "./viewport";

/** The address is not written at each step of a hand that moves. */
const restMs = 300;

/** Keeps what is seen of the picture in the address, and follows an address that came from elsewhere. */
export function useViewLink(viewport: Signal<Viewport | null>, pixel: PixelSize | null): void {
  const written = useRef<string | null>(null);
  const x = pixel?.x;
  const y = pixel?.y;

  useEffect(() => {
    if (x === undefined || y === undefined) return;
    const size = { x, y };
    let wait: ReturnType<typeof setTimeout> | undefined;
    const stopFollowing = effect(() => {
      const { query } = route.value;
      if (viewText(query) === written.current) return;
      written.current = viewText(query);
      viewport.value = viewFromLink(query, size);
    });
    const stopWriting = effect(() => {
      const view = viewport.value;
      clearTimeout(wait);
      wait = setTimeout(() => {
        const { path, query } = route.peek();
        const next = new URLSearchParams(query);
        next.delete("at");
        next.delete("zoom");
        const link = view ? viewToLink(view, size) : new URLSearchParams();
        link.forEach((value, name) => next.set(name, value));
        written.current = viewText(next);
        replaceHash(hashOf(path, next));
      }, restMs);
    });
    return () => {
      clearTimeout(wait);
      stopFollowing();
      stopWriting();
    };
  }, [x, y]);
}

function viewText(query: URLSearchParams): string {
  return `${query.get("at") ?? ""} ${query.get("zoom") ?? ""}`;
}
