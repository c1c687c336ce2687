import type { ComponentChildren, JSX } from "preact";

interface Props extends Omit<JSX.HTMLAttributes<HTMLButtonElement>, "type" | "size"> {
  /** plain: one of many; primary: what is most likely wanted; danger: can't be undone */
  kind?: "plain" | "primary" | "danger" | "quiet";
  /** Of a form? Else it does only what onClick does. */
  submit?: boolean;
  disabled?: boolean;
  children: ComponentChildren;
}

export function Button({ kind = "plain", submit = false, class: extra, ...rest }: Props) {
  const classes = ["button", `button-${kind}`, extra].filter(Boolean).join(" ");
  return <button type={submit ? "submit" : "button"} class={classes} {...rest} />;
}
