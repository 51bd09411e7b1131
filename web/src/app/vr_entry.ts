/** The button for VR; what it needs is loaded when it is pressed. */

import { makeHint } from "../model/hints";
import type { VrHost, VrStatus } from "../view3d/vr/host";
import { forcesOff } from "./hand_actions";
import { canSteer, store, studio, ui, viewport } from "./app_state";
import { number, t } from "./i18n";
import { stepTitle } from "./progress";

function describe(): VrStatus {
  const held = store.held.value[0] ?? null;
  const expected = store.expected.value;
  const hint = makeHint({
    scene: store.scene.value!,
    held,
    expected: expected?.occurrence ?? null,
    isDone: store.isDone.value,
    canSteer: canSteer(),
  });
  const alarm = store.forcesOff.value ? t("banner.forcesOff") : null;
  const safety = store.safety.value;
  return {
    title: stepTitle(),
    hint: t(hint.key === "hint.emptyExpected" ? "vr.takeExpected" : hint.key === "hint.empty" ? "vr.take" : hint.key, hint.params),
    alarm: safety !== null ? t("banner.safety", { reasons: safety.reasons.join(", ") }) : alarm,
    canUndo: store.history.value.undo !== null,
    isForcesOff: store.forcesOff.value,
  };
}

/** @param runNamed  Runs the action of this id. */
const makeHost = (runNamed: (id: string) => void): VrHost => ({
  say: (word) => t(`vr.${word}`),
  number,
  status: describe,
  run: (action) => {
    switch (action) {
      case "undo":
      case "next":
        runNamed(action);
        break;
      case "forces":
        if (store.forcesOff.value) {
          runNamed("forces-on");
        } else {
          forcesOff();
        }
        break;
      case "leave":
        void viewport.value?.renderer.xr.getSession()?.end();
        break;
    }
  },
});

/** Begins a session in the headset, or ends the one that there is. */
export async function enterVr(runNamed: (id: string) => void): Promise<void> {
  const host = makeHost(runNamed);
  const port = viewport.value;
  if (port === null) {
    return;
  }
  if (ui.isInVr.value) {
    host.run("leave");
    return;
  }
  const isSupported = await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false);
  if (!isSupported || store.scene.value === null) {
    studio.notify(t("notice.vrMissing"), true);
    return;
  }
  const { startVr } = await import("../view3d/vr/session");
  try {
    await startVr(port, studio, host, () => (ui.isInVr.value = false));
    ui.isInVr.value = true;
  } catch (error) {
    studio.notify(t("notice.vrFailed", { text: error instanceof Error ? error.message : String(error) }), true);
  }
}
