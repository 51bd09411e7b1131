import { ActionButton } from "./action_button";
import { findAction, runAction } from "./actions";
import { store, ui } from "./app_state";
import { deviceName } from "./device_name";
import { ForcesButton } from "./forces_button";
import { number, t } from "./i18n";
import { Icon } from "./icons";
import { MenuBar } from "./menu";
import { PeopleChip } from "./people";

function Chips() {
  const status = store.status.value;
  if (status === null) {
    return null;
  }
  const isSoft = status.scheduling !== "" && !/fifo|rr|deadline|real/i.test(status.scheduling);
  const device = store.hands.value.map(deviceName).join(" + ") || t("header.noDevice");
  return (
    <div class="chips">
      <span
        class={`chip ${isSoft ? "is-warn" : "is-good"}`}
        title={isSoft ? t("header.notRealtime", { scheduling: status.scheduling }) : undefined}
        data-testid="chip-device"
      >
        {t("header.device", {
          device,
          hz: number(status.tick_hz, 0),
          us: number(status.compute_p99_us, 0),
        })}
      </span>
      <span class="chip is-good chip-physics">{t("header.physics", { hz: number(status.physics_hz, 0) })}</span>
    </div>
  );
}

export function Header() {
  const scene = store.scene.value;
  return (
    <header class="header">
      <h1 class="product-name">
        <Icon name="logo" size={20} />
        <span>{scene?.name ?? t("app.title")}</span>
      </h1>
      <MenuBar />
      <span class="spacer" />
      <ActionButton id="undo" icon="undo" />
      <ActionButton id="redo" icon="redo" />
      <Chips />
      <PeopleChip />
      <ActionButton id="demo" icon="play" />
      <ActionButton id="mute" icon={findAction("mute").isOn?.() ? "mute" : "sound"} />
      <ActionButton id="theme" icon="theme" />
      <button
        type="button"
        class="icon-button narrow-only"
        aria-label={t("header.panels")}
        onClick={() => {
          const isShown = ui.panels.model.value || ui.panels.inspector.value;
          ui.panels.model.value = !isShown;
          ui.panels.inspector.value = !isShown;
        }}
      >
        <Icon name="panels" />
      </button>
      <ActionButton id="share" icon="share" label={t("header.share")} />
      <button
        type="button"
        class="vr-button"
        aria-label={findAction("enter-vr").label()}
        data-testid="enter-vr"
        disabled={scene === null}
        onClick={() => runAction(findAction("enter-vr"))}
      >
        <Icon name="headset" />
        <span>{findAction("enter-vr").label()}</span>
      </button>
      <ForcesButton />
    </header>
  );
}
