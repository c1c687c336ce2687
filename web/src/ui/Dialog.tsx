import { type ComponentChildren, createContext } from "preact";
import { useContext, useEffect, useId, useRef } from "preact/hooks";

/** What every dialog shows below its title: a modal one lies above all else of the page. */
export const DialogNotice = createContext<ComponentChildren>(null);

interface Props {
  title: string;
  /** Escape, the cross, or a click beside the dialog. */
  onClose: () => void;
  children: ComponentChildren;
  /** wide: for tables and pictures */
  wide?: boolean;
  /** It tells by itself what DialogNotice would. */
  withoutNotice?: boolean;
}

/** A modal dialog: the browser's own, which keeps the focus and gives it back. */
export function Dialog({ title, onClose, children, wide = false, withoutNotice }: Props) {
  const notice = useContext(DialogNotice);
  const dialog = useRef<HTMLDialogElement>(null);
  const isOpen = useRef(true);
  const titleId = useId();

  useEffect(() => {
    const shown = dialog.current;
    const before = document.activeElement;
    shown?.showModal?.();
    return () => {
      isOpen.current = false;
      shown?.close?.();
      if (before instanceof HTMLElement) before.focus();
    };
  }, []);

  return (
    <dialog
      ref={dialog}
      class={wide ? "dialog dialog-wide" : "dialog"}
      aria-labelledby={titleId}
      onCancel={(event) => {
        event.preventDefault();
        onClose();
      }}
      onClose={() => {
        // By the browser: after a second Escape it no longer asks. Whether it may is the owner's to say.
        if (!isOpen.current) return;
        dialog.current?.showModal?.();
        onClose();
      }}
      onMouseDown={(event) => {
        const shown = dialog.current;
        if (shown && event.target === shown && isBeside(event, shown)) onClose();
      }}
    >
      <div class="dialog-inside">
        <header class="dialog-head">
          <h2 id={titleId}>{title}</h2>
          <button type="button" class="icon-button" aria-label="Close" onClick={onClose}>
            ×
          </button>
        </header>
        {!withoutNotice && notice}
        {children}
      </div>
    </dialog>
  );
}

/** The dialog's backdrop counts as the dialog itself, and so does its scrollbar. */
function isBeside({ clientX, clientY }: MouseEvent, dialog: HTMLDialogElement): boolean {
  const { left, right, top, bottom } = dialog.getBoundingClientRect();
  return clientX < left || clientX > right || clientY < top || clientY > bottom;
}
