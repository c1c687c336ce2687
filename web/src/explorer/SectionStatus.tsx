import { lengthWords } from "../ui/lengths";
import { fixed } from "../ui/numbers";
import type { ExplorerState } from "./explorer_state";
import { layerAt } from "./geometry/cuboid";
import { norm, subtract } from "./geometry/vector3";
import type { SectionTools } from "./section_tools";

interface Props {
  state: ExplorerState;
  tools: SectionTools;
}

/** Below the section: where the cursor is, what was measured, how fine the picture is. */
export function SectionStatus({ state, tools }: Props) {
  const record = state.shownPicture.value?.record;
  const sharp = state.frame.value?.picture.sharp ?? state.settled.value;
  return (
    <div class="section-status">
      <span data-role="cursor">{placeWords(state, tools)}</span>
      {tools.tool.value === "measure" && (
        <span data-role="distance" role="status">
          {measureWords(tools)}
        </span>
      )}
      {tools.tool.value === "rectangle" && (
        <span role="status">Drag from one corner to the other.</span>
      )}
      {record && (
        <span class="muted">
          {sharp ? "Sharp" : "Preview"}, {lengthWords(record.pixel_um)} per pixel
        </span>
      )}
    </div>
  );
}

function placeWords(state: ExplorerState, tools: SectionTools): string {
  const pointer = tools.pointer.value;
  const place = pointer && state.sampleUnder(pointer);
  const cuboid = state.cuboid.value;
  if (!place || !cuboid) return "Point at the section to read its place.";
  const [x, y, z] = place.map((value) => fixed(value, 1));
  const at = `x ${x}, y ${y}, z ${z} µm`;
  const far = state.far.value;
  const outside = place.some((value, i) => value < -0.5 || value > far[i] + 0.5);
  if (outside) return `${at}: outside the block`;
  const layer = layerAt(cuboid, place[2]);
  return layer > state.layersPresent.value
    ? `${at}: layer ${layer}, not ground yet`
    : `${at}: layer ${layer}`;
}

function measureWords(tools: SectionTools): string {
  const measured = tools.measured.value;
  const how = "or go there by the arrow keys and press Enter.";
  if (!measured) return `Press on the first place, ${how}`;
  if (!measured.to) return `Press on the second place, ${how}`;
  return `Distance: ${fixed(norm(subtract(measured.to, measured.from)), 1)} µm`;
}
