import { effect, untracked } from "@preact/signals";
import { render } from "preact";
import { decodeMoment, decodeView, takeToken } from "../model/view_link";
import { followTraces, store, studio, view, viewport } from "./app_state";
import { logText } from "./event_list";
import { language, t } from "./i18n";
import { listenToKeys } from "./keyboard";
import { introduceOneself } from "./people";
import { keepPreferences } from "./preferences";
import { rememberParticipant, Root } from "./root";
import { showShared } from "./shared_link";
import { followScreen } from "./screen";
import { startSounds } from "./sounds";
import { exposeHooks } from "./test_hooks";
import { followTheme } from "./theme";
import "./styles/base.css";
import "./styles/layout.css";
import "./styles/panels.css";
import "./styles/view.css";
import "./styles/time.css";
import "./styles/people.css";
import "./styles/start.css";
import "./styles/phone.css";

const { token, rest } = takeToken(location.hash);
if (token !== null) {
  // It leaves the address bar before anything else can read it there.
  history.replaceState(null, "", rest === "" ? location.pathname : `#${rest}`);
}
const shared = decodeView(rest);
const moment = decodeMoment(rest);
keepPreferences();
followTraces();
followTheme();
followScreen();
effect(() => {
  document.documentElement.lang = language.value;
  document.title = store.study.value?.title || t("app.title");
});
effect(rememberParticipant);
introduceOneself();
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
