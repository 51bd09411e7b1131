/** A note on the part that is selected, pinned to where it was clicked. */

import { useSignal } from "@preact/signals";
import { inverse, kZero, sub, rotate, type Vec3 } from "../model/math";
import { store, studio, ui, view, viewport } from "./app_state";
import { Dialog, DialogHead } from "./dialog";
import { t } from "./i18n";

const close = () => (ui.overlay.value = null);

/** In the frame of the part: where it was clicked, or the middle of its mass. */
function placeOn(occurrence: number): Vec3 {
  const clicked = view.clickedAt.value;
  const X_WB = viewport.value?.product.poseOf(occurrence) ?? null;
  if (clicked?.occurrence === occurrence && X_WB !== null) {
    return rotate(inverse(X_WB).q, sub(clicked.p_W, X_WB.p));
  }
  return store.occurrences.value.get(occurrence)?.p_BoBcm_m ?? kZero;
}

export default function NoteDialog() {
  const text = useSignal("");
  const occurrence = view.selected.value[0];
  const part = occurrence === undefined ? "" : (store.occurrences.value.get(occurrence)?.name ?? "");
  const pin = async (event: Event) => {
    event.preventDefault();
    const said = text.value.trim();
    if (occurrence === undefined || said === "") {
      return;
    }
    if ((await studio.command({ command: "add_note", occurrence, p_B: placeOn(occurrence), text: said })) !== null) {
      close();
    }
  };
  return (
    <Dialog title={t("note.title")} kind="note" onClose={close}>
      <DialogHead title={t("note.title")} onClose={close} />
      <form class="dialog-body note-form" onSubmit={(event) => void pin(event)}>
        <label>
          <span>{t("note.text", { part })}</span>
          <textarea
            rows={3}
            maxLength={280}
            autofocus
            data-testid="note-text"
            value={text.value}
            onInput={(event) => (text.value = event.currentTarget.value)}
          />
        </label>
        <button type="submit" class="small-button is-main" disabled={text.value.trim() === ""} data-testid="note-pin">
          {t("note.pin")}
        </button>
      </form>
    </Dialog>
  );
}
