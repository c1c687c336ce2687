import { useEffect, useRef } from "preact/hooks";

import { type LayerKey, keepsKey, layerKey } from "./layer_keys";
import { shiftBy, zoomBy, zoomStep, zoomToPixels } from "./picture_controls";
import type { PictureScreen } from "./picture_screen";

/** What the keys of the Layers view do. */
export interface LayerKeyActions {
  step(by: number): void;
  page(by: -1 | 1): void;
  first(): void;
  last(): void;
  whole(): void;
  /** What is zoomed and moved; null where there is no picture. */
  screen(): PictureScreen | null;
}

function act(key: LayerKey, actions: LayerKeyActions): void {
  switch (key.kind) {
    case "step":
      return actions.step(key.by);
    case "page":
      return actions.page(key.by);
    case "first":
      return actions.first();
    case "last":
      return actions.last();
    case "whole":
      return actions.whole();
  }
  const screen = actions.screen();
  if (!screen) return;
  switch (key.kind) {
    case "larger":
      return zoomBy(screen, zoomStep);
    case "smaller":
      return zoomBy(screen, 1 / zoomStep);
    case "pixels":
      return zoomToPixels(screen);
    case "shift":
      return shiftBy(screen, key.parts);
  }
}

/** Keys act wherever the focus is, but for what has the focus and needs them itself. */
export function useLayerKeys(actions: LayerKeyActions): void {
  const latest = useRef(actions);
  latest.current = actions;
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      const key = layerKey(event);
      if (!key || event.defaultPrevented || document.querySelector("dialog[open]")) return;
      if (keepsKey(event.target instanceof Element ? event.target : null, key)) return;
      event.preventDefault();
      act(key, latest.current);
    };
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  }, []);
}
