import type { Point } from "./viewport";

/** What a key means in the Layers view. */
export type LayerKey =
  | { readonly kind: "step"; readonly by: number }
  | { readonly kind: "page"; readonly by: -1 | 1 }
  | { readonly kind: "first" | "last" | "larger" | "smaller" | "whole" | "pixels" }
  | { readonly kind: "shift"; readonly parts: Point };

export interface PressedKey {
  readonly key: string;
  readonly shiftKey: boolean;
  readonly ctrlKey: boolean;
  readonly altKey: boolean;
  readonly metaKey: boolean;
}

/** Part of the frame by which the picture goes on with Shift and an arrow. */
const shiftPart = 0.25;

const plain = new Map<string, LayerKey>(
  Object.entries({
    ArrowLeft: { kind: "step", by: -1 },
    ArrowRight: { kind: "step", by: 1 },
    PageUp: { kind: "page", by: -1 },
    PageDown: { kind: "page", by: 1 },
    Home: { kind: "first" },
    End: { kind: "last" },
    "+": { kind: "larger" },
    "=": { kind: "larger" }, // the key of + without Shift
    "-": { kind: "smaller" },
    "0": { kind: "whole" },
    "1": { kind: "pixels" },
  }),
);

const shifted = new Map<string, LayerKey>(
  Object.entries({
    ArrowLeft: { kind: "shift", parts: { x: -shiftPart, y: 0 } },
    ArrowRight: { kind: "shift", parts: { x: shiftPart, y: 0 } },
    ArrowUp: { kind: "shift", parts: { x: 0, y: -shiftPart } },
    ArrowDown: { kind: "shift", parts: { x: 0, y: shiftPart } },
    "+": { kind: "larger" },
  }),
);

export function layerKey(pressed: PressedKey): LayerKey | null {
  if (pressed.ctrlKey || pressed.altKey || pressed.metaKey) return null; // the browser's own
  return (pressed.shiftKey ? shifted : plain).get(pressed.key) ?? null;
}

/** Keys that scroll what has the focus, or change it. */
const scrolling: readonly LayerKey["kind"][] = ["page", "first", "last"];

/** Whether an element keeps a key for itself: a field, a list of its own, a dialog. */
export function keepsKey(element: Element | null, key: LayerKey): boolean {
  if (!element) return false;
  if (element.closest("dialog, select, textarea, .table-scroll")) return true;
  if (element.closest('input:not([type="checkbox"])')) return true;
  return scrolling.includes(key.kind) && element.closest(".layer-panel") !== null;
}
