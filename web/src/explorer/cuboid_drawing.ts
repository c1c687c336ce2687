import { effect } from "@preact/signals";
import type { ReadonlySignal } from "@preact/signals";

import { isDark } from "../ui/dark_scheme";
import type { CuboidRenderer, SceneColours } from "./cuboid_scene";
import type { ExplorerState } from "./explorer_state";
import { depthOfLayer } from "./geometry/cuboid";
import type { Projection } from "./orbit_camera";
import type { ElementSize } from "./use_size";

/** Draws in the next frame of the screen whenever what is drawn has changed. */
export function drawOnDemand(
  canvasOf: () => HTMLCanvasElement | null,
  state: ExplorerState,
  renderer: ReadonlySignal<CuboidRenderer | null>,
  projection: ReadonlySignal<Projection>,
  size: ReadonlySignal<ElementSize>,
): () => void {
  let frame = 0;
  const draw = () => {
    frame = 0;
    const canvas = canvasOf();
    const { width, height, ratio } = size.value;
    const cuboid = state.cuboid.value;
    if (!canvas || !renderer.value || !cuboid || width === 0 || height === 0) return;
    const [columns, rows] = [Math.floor(width * ratio), Math.floor(height * ratio)];
    if (canvas.width !== columns || canvas.height !== rows) {
      canvas.width = columns;
      canvas.height = rows;
    }
    const layers = state.layersPresent.value;
    renderer.value.draw(
      {
        projection: projection.value,
        far: state.far.value,
        depthPresent: depthOfLayer(cuboid, Math.max(1, layers)),
        picture: state.shownPicture.value,
        polygon: state.shownPlane.value?.polygon ?? [],
        colours: coloursOf(canvas),
      },
      ratio,
    );
  };
  const ask = () => {
    if (frame === 0) frame = requestAnimationFrame(draw);
  };
  const stop = effect(() => {
    void [renderer.value, projection.value, size.value, isDark.value];
    void [state.shownPlane.value, state.shownPicture.value];
    void [state.cuboid.value, state.layersPresent.value];
    ask();
  });
  // A graphics card that was reset, or had too little memory, gives back an empty canvas.
  const drawn = canvasOf();
  drawn?.addEventListener("webglcontextrestored", ask);
  return () => {
    stop();
    drawn?.removeEventListener("webglcontextrestored", ask);
    cancelAnimationFrame(frame);
  };
}

function coloursOf(element: Element): SceneColours {
  const style = getComputedStyle(element);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  return {
    line: colour("--line-strong"),
    missing: colour("--muted"),
    plane: colour("--accent"),
  };
}
