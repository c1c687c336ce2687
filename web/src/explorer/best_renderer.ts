import { canvasRenderer } from "./canvas_renderer";
import type { CuboidRenderer } from "./cuboid_scene";

function hasWebgl(): boolean {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}

/** With the graphics card where there is one. A canvas that was tried in vain is of no more use. */
export async function bestRenderer(canvas: HTMLCanvasElement): Promise<CuboidRenderer> {
  if (!hasWebgl()) return canvasRenderer(canvas);
  const { webglRenderer } = await import("./webgl_renderer");
  return webglRenderer(canvas);
}
