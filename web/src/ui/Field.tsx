import { type ComponentChildren, type VNode, cloneElement } from "preact";
import { useId } from "preact/hooks";

interface Props {
  label: ComponentChildren;
  hint?: ComponentChildren;
  /** One control: an input, a select. */
  children: VNode;
}

/** A control with its label above it. */
export function Field({ label, hint, children }: Props) {
  const id = useId();
  const hintId = `${id}-hint`;
  return (
    <div class="field">
      <label class="field-label" for={id}>
        {label}
      </label>
      {cloneElement(children, { id, "aria-describedby": hint ? hintId : undefined })}
      {hint && (
        <span class="field-hint" id={hintId}>
          {hint}
        </span>
      )}
    </div>
  );
}
