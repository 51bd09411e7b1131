/** Which of the views this page has: the studio, with a study or without, or the participant's. */

import { App } from "./app";
import { store, studio } from "./app_state";
import { t } from "./i18n";
import { Lazy } from "./lazy";

const kKey = "hvas-participant";

/** Nothing of the studio is shown, not even for a moment, where a participant may look on. */
function mayBeParticipant(hasToken: boolean): boolean {
  try {
    return hasToken || sessionStorage.getItem(kKey) !== null;
  } catch {
    return hasToken;
  }
}

export function rememberParticipant(): void {
  try {
    if (studio.study.isParticipantView.value) {
      sessionStorage.setItem(kKey, "1");
    } else if (store.isGreeted.value) {
      sessionStorage.removeItem(kKey);
    }
  } catch {
    // Without storage the studio may be seen for a moment when the page is loaded anew.
  }
}

export function Root({ hasToken }: { hasToken: boolean }) {
  if (studio.study.isParticipantView.value) {
    return <Lazy load={() => import("./study/participant")} />;
  }
  if (!store.isGreeted.value && store.link.value !== "denied" && mayBeParticipant(hasToken)) {
    return (
      <main class="study-wait">
        <p class="quiet">{t("empty.waiting")}</p>
      </main>
    );
  }
  return <App />;
}
