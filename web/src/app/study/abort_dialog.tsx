/** A trial that is aborted is lost: so it is asked why, before. */

import { useSignal } from "@preact/signals";
import { studio } from "../app_state";
import { Dialog, DialogHead } from "../dialog";
import { t } from "../i18n";

export function AbortDialog({ onClose }: { onClose: () => void }) {
  const reason = useSignal("");
  const isMissed = useSignal(false);
  const abort = async (event: Event) => {
    event.preventDefault();
    isMissed.value = reason.value.trim() === "";
    if (!isMissed.value && (await studio.study.abort(reason.value.trim()))) {
      onClose();
    }
  };
  return (
    <Dialog title={t("desk.abortTitle")} kind="abort" onClose={onClose}>
      <DialogHead title={t("desk.abortTitle")} onClose={onClose} />
      <form class="desk-form" onSubmit={(event) => void abort(event)}>
        <p>{t("desk.abortAbout")}</p>
        <label>
          {t("desk.reason")}
          <textarea
            rows={3}
            value={reason.value}
            aria-invalid={isMissed.value}
            aria-describedby={isMissed.value ? "abort-missed" : undefined}
            data-testid="abort-reason"
            onInput={(event) => {
              reason.value = event.currentTarget.value;
              isMissed.value = false;
            }}
          />
        </label>
        <p id="abort-missed" class="desk-fault" role="alert">
          {isMissed.value ? t("desk.reasonMissed") : ""}
        </p>
        <p class="desk-buttons">
          <button type="submit" class="small-button desk-button is-abort" data-testid="abort-yes">
            {t("desk.abortYes")}
          </button>
          <button type="button" class="small-button desk-button" onClick={onClose}>
            {t("desk.abortNo")}
          </button>
        </p>
      </form>
    </Dialog>
  );
}
