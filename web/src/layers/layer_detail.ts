import { useEffect, useState } from "preact/hooks";

import { getJson, isAbort, sentenceOf } from "../api/client";
import { persistently } from "../api/retry_wait";
import type { LayerDetail, Sharpness } from "../api/types";
import { committed, marks } from "./layers_state";

export interface Answer<T> {
  readonly value: T | null;
  /** Why there is none; empty while it is on its way. */
  readonly trouble: string;
}

const onItsWay = { value: null, trouble: "" };
const usualWaitMs = 1500;

/** What an address answers with; asked anew when `version` changes, and then kept until it comes. */
function useAnswer<T>(address: string | null, version = ""): Answer<T> {
  const [state, setState] = useState<{ address: string | null; answer: Answer<T> }>({
    address: null,
    answer: onItsWay,
  });

  useEffect(() => {
    if (address === null) return;
    const ended = new AbortController();
    persistently((signal) => getJson<T>(address, signal), ended.signal, usualWaitMs).then(
      (value) => setState({ address, answer: { value, trouble: "" } }),
      (error: unknown) => {
        if (isAbort(error)) return;
        setState({ address, answer: { value: null, trouble: sentenceOf(error) } });
      },
    );
    return () => ended.abort();
  }, [address, version]);

  return address !== null && state.address === address ? state.answer : onItsWay;
}

/** A layer and its attempts, as they are now. */
export function useLayerDetail(layer: number | null): Answer<LayerDetail> {
  const mark = marks.value.byLayer.get(layer ?? 0);
  const version = JSON.stringify([mark, layer !== null && layer <= committed.value]);
  return useAnswer<LayerDetail>(layer === null ? null : `/api/v1/layers/${layer}`, version);
}

/** The tile map of sharpness of a layer's image. */
export function useSharpness(layer: number | null): Answer<Sharpness> {
  return useAnswer<Sharpness>(layer === null ? null : `/api/v1/layers/${layer}/sharpness`);
}
