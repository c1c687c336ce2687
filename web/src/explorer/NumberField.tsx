import { useState } from "preact/hooks";

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

/** A number that is taken when it was typed to its end; until then what is typed stays as it is. */
export function NumberField({ label, value, decimals = 3, unit, onChange, ...limits }: Props) {
  const [draft, setDraft] = useState<string | null>(null);
  return (
    <label class="number-field">
      <span class="number-label">{label}</span>
      <input
        type="number"
        inputMode="decimal"
        step="any"
        value={draft ?? shown(value, decimals)}
        {...limits}
        onInput={(event) => setDraft(event.currentTarget.value)}
        onBlur={() => setDraft(null)}
        onChange={(event) => {
          setDraft(null);
          const typed = event.currentTarget.valueAsNumber;
          const taken = Number.isFinite(typed) && onChange(typed) !== false;
          if (!taken) event.currentTarget.value = shown(value, decimals);
        }}
      />
      {unit && <span class="number-unit">{unit}</span>}
    </label>
  );
}
