interface Props {
  label: string;
  value: number;
  decimals?: number;
  min?: number;
  max?: number;
  step?: number;
  unit?: string;
  /** False refuses: what was typed is taken back. */
  onChange: (value: number) => boolean | void;
}

const shown = (value: number, decimals: number): string => String(Number(value.toFixed(decimals)));

/** A number that is taken when it was typed to its end. */
export function NumberField({ label, value, decimals = 3, unit, onChange, ...limits }: Props) {
  return (
    <label class="number-field">
      <span class="number-label">{label}</span>
      <input
        type="number"
        inputMode="decimal"
        step="any"
        value={shown(value, decimals)}
        {...limits}
        onChange={(event) => {
          const typed = event.currentTarget.valueAsNumber;
          const taken = Number.isFinite(typed) && onChange(typed) !== false;
          if (!taken) event.currentTarget.value = shown(value, decimals);
        }}
      />
      {unit && <span class="number-unit">{unit}</span>}
    </label>
  );
}
