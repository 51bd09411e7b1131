/** What stands before everything else until it is closed. */

import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { store } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";
import { ForcesButton } from "./forces_button";
import { isPhone } from "./screen";

interface DialogProps {
  title: string;
  kind: string;
  onClose: () => void;
  children: ComponentChildren;
}

export function Dialog({ title, kind, onClose, children }: DialogProps) {
  const box = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const dialog = box.current;
    dialog?.showModal();
    return () => dialog?.close();
  }, []);
  return (
    <dialog
      class={`dialog is-${kind}`}
      aria-label={title}
      ref={box}
      data-testid={kind}
      onCancel={onClose}
      onClick={(event) => {
        // The backdrop is the dialog itself.
        if (event.target === box.current) {
          onClose();
        }
      }}
    >
      {children}
      <Refusal />
    </dialog>
  );
}

/** The page's own notices are out of reach behind it. */
function Refusal() {
  const notice = store.notice.value;
  const failure = store.failure.value;
  const text = notice?.isError ? notice.text : failure === null ? "" : `${failure.message} ${failure.where}. ${failure.remedy}`;
  return (
    <div role="status" aria-live="polite">
      {text === "" ? null : <p class="note is-bad dialog-refusal">{text}</p>}
    </div>
  );
}

export function DialogHead({ title, onClose }: { title: string; onClose: () => void }) {
  return (
    <header class="dialog-head">
      <h2>{title}</h2>
      {isPhone.value ? <ForcesButton /> : null}
      <button type="button" class="icon-button" aria-label={t("dialog.close")} onClick={onClose}>
        <Icon name="close" />
      </button>
    </header>
  );
}
