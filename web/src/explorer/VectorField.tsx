import { NumberField } from "./NumberField";
import type { Vector3 } from "./geometry/vector3";

interface Props {
  label: string;
  value: Vector3;
  decimals?: number;
  onChange: (value: Vector3) => boolean | void;
}

/** x, y and z of a place or a direction. */
export function VectorField({ label, value, decimals = 3, onChange }: Props) {
  return (
    <fieldset class="vector-field">
      <legend>{label}</legend>
      {([0, 1, 2] as const).map((axis) => (
        <NumberField
          key={axis}
          label={"xyz"[axis]}
          value={value[axis]}
          decimals={decimals}
          onChange={(typed) =>
            onChange(value.map((old, i) => (i === axis ? typed : old)) as unknown as Vector3)
          }
        />
      ))}
    </fieldset>
  );
}
