import { effect, untracked } from "@preact/signals";
import { render } from "preact";
import { decodeMoment, decodeView } from "../model/view_link";
import { followTraces, store, studio, view, viewport } from "./app_state";
import { logText } from "./event_list";
import { language, t } from "./i18n";
import { listenToKeys } from "./keyboard";
import { keepPreferences } from "./preferences";
import { rememberParticipant, Root } from "./root";
import { showShared } from "./shared_link";
import { startSounds } from "./sounds";
import { exposeHooks } from "./test_hooks";
import { followTheme } from "./theme";
import "./styles/base.css";
import "./styles/layout.css";
import "./styles/panels.css";
import "./styles/view.css";
import "./styles/time.css";

/** The token of the link leaves the address bar before anything else can read it there. */
function takeToken(): string | null {
  const match = /^#t=([\w-]+)/.exec(location.hash);
  if (match !== null) {
    history.replaceState(null, "", location.pathname);
  }
  return match?.[1] ?? null;
}

const token = takeToken();
const shared = decodeView(location.hash);
const moment = decodeMoment(location.hash);
keepPreferences();
followTraces();
followTheme();
effect(() => {
  document.documentElement.lang = language.value;
  document.title = store.study.value?.title || t("app.title");
});
effect(rememberParticipant);
render(<Root hasToken={token !== null} />, document.getElementById("app")!);
listenToKeys();
startSounds();
exposeHooks();
showShared(shared, moment);
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const followCalm = () => (view.isCalm.value = calm.matches);
followCalm();
calm.addEventListener("change", followCalm);
effect(() => viewport.value?.rig.setReducedMotion(view.isCalm.value));
effect(() => {
  const last = store.live.log.value[0];
  if (last?.params["missing_mm"] !== undefined) {
    untracked(() => studio.notify(logText(last), true));
  }
});
effect(() => {
  if (view.isSlow.value && view.quality.value === "auto") {
    studio.notify(t("notice.slow"));
  }
});
void studio.start(token);
