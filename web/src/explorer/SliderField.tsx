import { NumberField } from "./NumberField";

interface Props {
  label: string;
  value: number;
  min: number;
  max: number;
  step: number;
  decimals: number;
  unit: string;
  onChange: (value: number) => void;
}

/** A slider with the number that it stands at, which may be typed as well. */
export function SliderField({ label, value, min, max, step, decimals, unit, onChange }: Props) {
  return (
    <div class="slider-field">
      <NumberField
        label={label}
        value={value}
        decimals={decimals}
        unit={unit}
        onChange={onChange}
      />
      <input
        type="range"
        aria-label={`${label}, ${unit}`}
        min={min}
        max={max}
        step={step}
        value={value}
        onInput={(event) => onChange(event.currentTarget.valueAsNumber)}
      />
    </div>
  );
}
