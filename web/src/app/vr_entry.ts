/** The button for VR; what it needs is loaded when it is pressed. */

import { store, studio, ui, viewport } from "./app_state";
import { t } from "./i18n";

export async function enterVr(): Promise<void> {
  const port = viewport.value;
  if (port === null) {
    return;
  }
  if (ui.isInVr.value) {
    await port.renderer.xr.getSession()?.end();
    return;
  }
  const isSupported = await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false);
  if (!isSupported || store.scene.value === null) {
    studio.notify(t("notice.vrMissing"), true);
    return;
  }
  const { startVr } = await import("../view3d/vr_session");
  ui.isInVr.value = true;
  await startVr(port, studio, () => (ui.isInVr.value = false));
}
