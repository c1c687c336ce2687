import type { ComponentChildren } from "preact";

interface Props {
  label: ComponentChildren;
  hint?: ComponentChildren;
  /** One control: an input, a select. */
  children: ComponentChildren;
}

/** A control with its label above it. */
export function Field({ label, hint, children }: Props) {
  return (
    <label class="field">
      <span class="field-label">{label}</span>
      {children}
      {hint && <span class="field-hint">{hint}</span>}
    </label>
  );
}
