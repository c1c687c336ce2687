import { useMemo } from "preact/hooks";

import type { Sharpness } from "../api/types";
import { useSharpness } from "./layer_detail";
import { changeMap, changeRange, shownRange, type ValueRange } from "./sharpness_map";

/** What the map shows: the layer's own sharpness, or how it changed from the layer before. */
export type MapKind = "own" | "change";

export interface ShownMap {
  readonly map: Sharpness;
  readonly kind: MapKind;
  /** Of the colours; null where no tile has a value. */
  readonly range: ValueRange | null;
}

export interface SharpnessAnswer {
  readonly shown: ShownMap | null;
  /** Why there is none; empty while it is on its way. */
  readonly trouble: string;
}

const none: SharpnessAnswer = { shown: null, trouble: "" };

/** The map of a layer; of none, where it is null. The first layer has none before it. */
export function useShownMap(layer: number | null, kind: MapKind): SharpnessAnswer {
  const own = useSharpness(layer);
  const first = layer === 1 && kind === "change";
  const before = useSharpness(layer !== null && kind === "change" && !first ? layer - 1 : null);
  return useMemo(() => {
    if (layer === null) return none;
    if (first) return { shown: null, trouble: "There is no layer before this one." };
    const trouble = own.trouble || before.trouble;
    if (!own.value || (kind === "change" && !before.value)) return { shown: null, trouble };
    return { shown: shownMap(own.value, before.value), trouble };
  }, [layer, kind, first, own, before]);
}

function shownMap(own: Sharpness, before: Sharpness | null): ShownMap {
  if (!before) return { map: own, kind: "own", range: shownRange(own) };
  const map = changeMap(own, before);
  const some = map.values.some((value) => value !== null);
  return { map, kind: "change", range: some ? changeRange : null };
}
