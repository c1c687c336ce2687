import { Field } from "../ui/Field";
import type { ExplorerState } from "./explorer_state";
import { NumberField } from "./NumberField";
import { wayStep } from "./series_choice";
import type { SeriesChoice } from "./series_choice";
import type { SeriesPlayer } from "./series_player";
import { VectorField } from "./VectorField";

interface Props {
  state: ExplorerState;
  player: SeriesPlayer;
}

/** Which planes follow each other, begun from the one that is shown. */
export function SeriesFields({ state, player }: Props) {
  const choice = player.choice.value;
  const placed = state.placed.value;
  const cuboid = state.cuboid.value;
  const change = (changed: Partial<SeriesChoice>) => {
    player.close();
    player.choice.value = { ...choice, ...changed };
  };
  const turn = (part: Partial<SeriesChoice["turn"]>) =>
    change({ turn: { ...choice.turn, ...part } });
  return (
    <div class="series-fields">
      <Field label="The plane">
        <select
          value={choice.kind}
          onChange={(event) =>
            change({ kind: event.currentTarget.value === "translate" ? "translate" : "rotate" })
          }
        >
          <option value="rotate">turns about an axis</option>
          <option value="translate">moves along its normal</option>
        </select>
      </Field>
      {choice.kind === "rotate" ? (
        <>
          <Field label="Axis">
            <select
              value={choice.axis}
              onChange={(event) =>
                change({ axis: event.currentTarget.value as SeriesChoice["axis"] })
              }
            >
              <option value="x">x</option>
              <option value="y">y</option>
              <option value="z">z</option>
              <option value="own">my own</option>
            </select>
          </Field>
          {choice.axis === "own" && (
            <VectorField
              label="Direction of the axis"
              value={choice.ownAxis}
              onChange={(ownAxis) => {
                if (ownAxis.every((part) => part === 0)) return false;
                change({ ownAxis });
                return true;
              }}
            />
          )}
          <div class="three-numbers">
            <NumberField
              label="From, °"
              value={choice.turn.from}
              onChange={(from) => turn({ from })}
            />
            <NumberField label="To, °" value={choice.turn.to} onChange={(to) => turn({ to })} />
            <NumberField
              label="Step, °"
              value={choice.turn.step}
              onChange={(step) => (step === 0 ? false : turn({ step }))}
            />
          </div>
        </>
      ) : (
        placed &&
        cuboid && (
          <NumberField
            label="Step"
            value={wayStep(choice, placed, cuboid)}
            unit="µm, through the whole block"
            onChange={(step) => (step > 0 ? change({ way: { step } }) : false)}
          />
        )
      )}
    </div>
  );
}
