import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { bestRenderer } from "./best_renderer";
import { drawOnDemand } from "./cuboid_drawing";
import { cuboidKeys, pressedOnCuboid } from "./cuboid_keys";
import type { CuboidRenderer } from "./cuboid_scene";
import { CuboidOverlay } from "./CuboidOverlay";
import type { ExplorerState } from "./explorer_state";
import { projected, projectionOf } from "./orbit_camera";
import { useCuboidPointer } from "./use_cuboid_pointer";
import { useSize } from "./use_size";

interface Props {
  state: ExplorerState;
}

/** The block with the plane in it. It is drawn anew only when something changed. */
export function CuboidView({ state }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const renderer = useSignal<CuboidRenderer | null>(null);
  const failure = useSignal("");
  const held = useSignal<number | null>(null); // the point that is being moved
  const size = useSize(box);

  const projection = useComputed(() =>
    projectionOf(state.camera.value, state.far.value, size.value.width, size.value.height),
  );
  const handles = useComputed(() =>
    (state.shownPlane.value?.points ?? []).map((point) => projected(projection.value, point)),
  );

  useEffect(() => {
    let wanted = true;
    bestRenderer(canvas.current!).then(
      (made) => (wanted ? (renderer.value = made) : made.dispose()),
      () => (failure.value = "The block can't be drawn in this browser."),
    );
    return () => {
      wanted = false;
      renderer.value?.dispose();
    };
  }, []);

  useEffect(() => drawOnDemand(() => canvas.current, state, renderer, projection, size), []);
  useCuboidPointer(canvas, state, projection, handles, held);

  return (
    <div class="cuboid" ref={box}>
      <canvas
        ref={canvas}
        class="cuboid-canvas"
        data-role="cuboid"
        data-handles={JSON.stringify(
          handles.value.map((at) => at.map((v) => Math.round(v * 10) / 10)),
        )}
        tabIndex={0}
        role="application"
        aria-label="Block"
        aria-describedby="block-keys"
        onKeyDown={(event) => pressedOnCuboid(event, state, projection.value, held)}
        onBlur={() => (held.value = null)}
      />
      <p id="block-keys" hidden>
        {cuboidKeys}
      </p>
      {size.value.width > 0 && (
        <CuboidOverlay state={state} projection={projection} handles={handles} held={held} />
      )}
      {failure.value && <p class="notice notice-warn">{failure.value}</p>}
    </div>
  );
}
