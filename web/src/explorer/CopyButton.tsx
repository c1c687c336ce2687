import { useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { sentenceOf } from "../api/client";
import { Button } from "../ui/Button";
import { Dialog } from "../ui/Dialog";
import { copyText } from "./copy_text";

interface Props {
  what: string; // it is called in the dialog
  text: () => string | Promise<string>;
  children: ComponentChildren;
}

const told_ms = 2000;

/** Copies, and says so; where that is forbidden, shows the text to be copied by hand. */
export function CopyButton({ what, text, children }: Props) {
  const told = useSignal("");
  const byHand = useSignal<string | null>(null);
  const forgetting = useRef<ReturnType<typeof setTimeout>>();
  useEffect(() => () => clearTimeout(forgetting.current), []);
  const copy = async () => {
    clearTimeout(forgetting.current); // of what was copied before
    try {
      const copied = await text();
      if (await copyText(copied)) told.value = "Copied";
      else byHand.value = copied;
    } catch (error) {
      told.value = sentenceOf(error);
    }
    forgetting.current = setTimeout(() => (told.value = ""), told_ms);
  };
  return (
    <>
      <Button onClick={() => void copy()}>
        <span aria-live="polite">{told.value || children}</span>
      </Button>
      {byHand.value !== null && (
        <Dialog title={what} onClose={() => (byHand.value = null)}>
          <textarea
            class="copy-text"
            readOnly
            rows={5}
            aria-label={what}
            value={byHand.value}
            ref={(area) => area?.select()}
          />
          <p class="muted">Copy it with the keyboard: Ctrl+C, or Command+C on a Mac.</p>
        </Dialog>
      )}
    </>
  );
}
