/** What the start page shows besides files: which devices are there, and what the program does, as a small animation. */

import { useEffect } from "preact/hooks";
import { store, studio, ui } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";

/** Force-feedback devices that were found, and what can be used without one. */
export function StartDevices() {
  useEffect(() => {
    if (store.role.peek() === "operator") {
      void studio.command({ command: "devices" }).then((list) => {
        store.devices.value = list ?? store.devices.value;
      });
    }
  }, []);
  const devices = store.devices.value;
  const found = devices?.devices.filter((device) => device.is_ready && !device.is_emulated) ?? [];
  return devices === null ? null : (
    <div class="start-devices" data-testid="start-devices" aria-busy={devices.is_searching}>
      <Icon name="device" size={20} />
      <span>
        {devices.is_searching
          ? t("start.searching")
          : found.length > 0
            ? t("start.found", { devices: found.map((device) => device.name).join(", ") })
            : t("start.none")}
      </span>
      <button type="button" class="link-like" onClick={() => (ui.overlay.value = { kind: "devices" })}>
        {t("start.devices")}
      </button>
    </div>
  );
}

/** A shaft is drawn onto the axis of a bore, goes in, and comes out again; still where motion is not wanted. */
export function StartDemo() {
  return (
    <svg class="start-demo" viewBox="0 0 480 260" aria-hidden="true" data-testid="start-demo">
      <path class="demo-axis" d="M20 130H460" />
      <path class="demo-block" d="M250 50h150v60H250zM250 150h150v60H250z" />
      <path class="demo-hatch" d="M262 110l60-60M302 110l60-60M342 110l58-58M262 210l60-60M302 210l60-60M342 210l58-58" />
      <g class="demo-shaft">
        <path d="M40 112h130l10 6v24l-10 6H40z" />
        <path class="demo-edge" d="M170 112v36" />
      </g>
      <path class="demo-force" d="M0 0h-46m12-8l-12 8 12 8" />
    </svg>
  );
}
