import { Button } from "../ui/Button";
import { Switch } from "../ui/Switch";
import type { ExplorerState } from "./explorer_state";
import { layerAt } from "./geometry/cuboid";
import { NumberField } from "./NumberField";
import {
  movePoint,
  nudge,
  setNormal,
  setOffset,
  setThrough,
  stand,
  toDiagonal,
  toLayer,
  turn,
} from "./plane_moves";
import { isAlongLayers, stepAlong } from "./plane_state";
import { SliderField } from "./SliderField";
import { VectorField } from "./VectorField";

interface Props {
  state: ExplorerState;
}

/** Ways to move the plane. All of them show the same plane. */
export function PlaneControls({ state }: Props) {
  const placed = state.shownPlane.value;
  const cuboid = state.cuboid.value;
  if (!placed || !cuboid) return null;
  const { normal } = placed.plane;
  const [least, most] = placed.offsets;
  const along = isAlongLayers(placed.plane);
  const grows = state.layersPresent.value < cuboid.size[2];
  const layer = layerAt(cuboid, along ? placed.offset : placed.through[2]);
  return (
    <section class="panel explorer-panel" aria-labelledby="plane-title">
      <h2 id="plane-title">Plane</h2>
      <div class="plane-shortcuts" role="group" aria-label="Shortcuts">
        <Button aria-pressed={along} onClick={() => toLayer(state, layer)}>
          Along layers
        </Button>
        <Button onClick={() => stand(state, "xz")}>x-z</Button>
        <Button onClick={() => stand(state, "yz")}>y-z</Button>
        <Button onClick={() => toDiagonal(state)}>Diagonal</Button>
      </div>
      <div class="layer-row">
        <NumberField
          label="Layer"
          value={layer}
          decimals={0}
          min={1}
          max={cuboid.size[2]}
          step={1}
          unit={`of ${cuboid.size[2]}`}
          onChange={(typed) => toLayer(state, typed)}
        />
        {(grows || state.follow.value) && (
          <Switch
            checked={state.follow.value}
            onChange={(on) => (on ? state.toNewest() : (state.follow.value = false))}
          >
            Newest face
          </Switch>
        )}
      </div>
      <SliderField
        label="Tilt"
        value={placed.angles.tilt}
        min={0}
        max={90}
        step={0.5}
        decimals={2}
        unit="°"
        onChange={(tilt) => turn(state, { tilt })}
      />
      <SliderField
        label="Azimuth"
        value={placed.angles.azimuth}
        min={-180}
        max={180}
        step={0.5}
        decimals={2}
        unit="°"
        onChange={(azimuth) => turn(state, { azimuth })}
      />
      <SliderField
        label={along ? "Depth" : "Offset"}
        value={placed.offset}
        min={least}
        max={most}
        step={stepAlong(normal, cuboid)}
        decimals={2}
        unit="µm"
        onChange={(offset) => setOffset(state, offset)}
      />
      <div class="plane-steps" role="group" aria-label="One step">
        <Button onClick={() => nudge(state, -1)}>− 1 step</Button>
        <Button onClick={() => nudge(state, 1)}>+ 1 step</Button>
      </div>
      <details>
        <summary>Normal and point</summary>
        <VectorField
          label="Normal"
          decimals={6}
          value={placed.definition.kind === "normal" ? placed.definition.normal : normal}
          onChange={(typed) => setNormal(state, typed)}
        />
        <VectorField
          label="Through, µm"
          value={placed.through}
          onChange={(typed) => setThrough(state, typed)}
        />
      </details>
      <details>
        <summary>Three points</summary>
        {placed.points.map((point, i) => (
          <VectorField
            key={i}
            label={`Point ${i + 1}, µm`}
            value={point}
            onChange={(typed) => movePoint(state, i, typed)}
          />
        ))}
      </details>
    </section>
  );
}
