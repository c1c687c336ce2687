import { useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";

import { judged } from "./layers_state";
import { RejectedList } from "./RejectedList";

/** Beside the picture: this layer, or the list of all rejected frames. */
export function LayerPanel({ children }: { children: ComponentChildren }) {
  const list = useSignal(false);
  const choice = (label: string, isList: boolean) => (
    <button
      type="button"
      class="segment-button"
      aria-pressed={list.value === isList}
      onClick={() => (list.value = isList)}
    >
      {label}
    </button>
  );
  return (
    <aside class="layer-panel" aria-label="About the layer">
      {judged.value && (
        <div class="segments" role="group" aria-label="Shown here">
          {choice("This layer", false)}
          {choice("Rejected frames", true)}
        </div>
      )}
      {judged.value && list.value ? <RejectedList /> : children}
    </aside>
  );
}
