import { Button } from "../ui/Button";
import { Field } from "../ui/Field";
import { lengthWords } from "../ui/lengths";
import { Switch } from "../ui/Switch";
import type { ExplorerState } from "./explorer_state";
import { cornersOf } from "./geometry/plane_rectangle";
import { norm, subtract } from "./geometry/vector3";
import type { Colour, Interpolation, Theta } from "./section_choices";
import type { SectionTools } from "./section_tools";
import { customBetween } from "./theta_frame";

interface Props {
  state: ExplorerState;
  tools: SectionTools;
}

/** What becomes the picture, and how it is drawn. */
export function SectionControls({ state, tools }: Props) {
  const { basis, theta, interpolation, background } = state.choices.value;
  const edges = state.placed.value?.polygon.length ?? 0;
  const rectangle = state.rectangle.value;
  const drawing = tools.tool.value === "rectangle";
  return (
    <section class="panel explorer-panel" aria-labelledby="picture-title">
      <h2 id="picture-title">Picture</h2>
      <Field
        label="Rectangle"
        hint={rectangle && `${lengthWords(rectangle.width)} × ${lengthWords(rectangle.height)}`}
      >
        <select
          value={theta.kind === "edge" ? `edge:${theta.edge}` : theta.kind}
          onChange={(event) => chooseTheta(state, tools, event.currentTarget.value)}
        >
          <option value="bounding">Whole section</option>
          <option value="inscribed">Largest inside</option>
          <option value="inscribed-any">Largest inside, at any angle</option>
          {Array.from({ length: edges }, (_, i) => (
            <option key={i} value={`edge:${i}`}>
              Largest on edge {i}
            </option>
          ))}
          <option value="custom">My own</option>
        </select>
      </Field>
      {theta.kind !== "bounding" && (
        <Switch checked={state.around.value} onChange={(on) => showAround(state, on)}>
          Show what lies around it
        </Switch>
      )}
      {theta.kind === "custom" && (
        <Button aria-pressed={drawing} onClick={() => tools.take(drawing ? "look" : "rectangle")}>
          Draw it anew
        </Button>
      )}
      <Field label="Rows of the picture">
        <select
          value={basis}
          onChange={(event) =>
            state.choose({ basis: event.currentTarget.value === "xz" ? "xz" : "layer" })
          }
        >
          <option value="layer">Along the layers</option>
          <option value="xz">Along x–z planes</option>
        </select>
      </Field>
      <Field label="Between voxels">
        <select
          value={interpolation}
          onChange={(event) =>
            state.choose({ interpolation: event.currentTarget.value as Interpolation })
          }
        >
          <option value="nearest">Nearest voxel</option>
          <option value="linear">Linear</option>
          <option value="cubic">Cubic</option>
        </select>
      </Field>
      <Field label="Outside the block">
        <input
          type="color"
          value={hexOf(background)}
          onChange={(event) => state.choose({ background: colourOf(event.currentTarget.value) })}
        />
      </Field>
    </section>
  );
}

function showAround(state: ExplorerState, on: boolean): void {
  state.around.value = on;
  state.closeup.value = null;
}

function chooseTheta(state: ExplorerState, tools: SectionTools, name: string): void {
  if (name === "custom") {
    state.around.value = true;
    const custom = halfOf(state);
    if (custom) state.choose({ theta: custom });
    return;
  }
  tools.take("look");
  const [kind, edge] = name.split(":");
  state.choose({
    theta: (edge === undefined ? { kind } : { kind, edge: Number(edge) }) as Theta,
  });
}

/** The middle of the rectangle there is, to begin with. */
function halfOf(state: ExplorerState): Theta | null {
  const rectangle = state.rectangle.value;
  if (!rectangle) return null;
  const [first, , opposite] = cornersOf(rectangle);
  const between = (part: number) =>
    first.map((value, i) => value + part * (opposite[i] - value)) as unknown as typeof first;
  if (norm(subtract(opposite, first)) === 0) return null;
  return customBetween(rectangle, 0, between(0.25), between(0.75));
}

const hexOf = (colour: Colour): string =>
  `#${colour.map((part) => part.toString(16).padStart(2, "0")).join("")}`;

const colourOf = (hex: string): Colour => [
  parseInt(hex.slice(1, 3), 16),
  parseInt(hex.slice(3, 5), 16),
  parseInt(hex.slice(5, 7), 16),
];
