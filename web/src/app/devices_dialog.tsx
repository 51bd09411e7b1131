/** The hands, what each of them is, and the devices that could be. */

import { useEffect } from "preact/hooks";
import { kMaxHands } from "../protocol/frames";
import type { FoundDevice } from "../protocol/messages";
import { findAction, runAction } from "./actions";
import { canSteer, store, studio, ui } from "./app_state";
import { Dialog, DialogHead } from "./dialog";
import { HandCard, leads, putInto } from "./hand_card";
import { t } from "./i18n";
import { Icon } from "./icons";
import { Rates } from "./rates";

const close = () => (ui.overlay.value = null);

async function search(): Promise<void> {
  const list = await studio.command({ command: "devices" });
  if (list !== null) {
    store.devices.value = list;
  }
}

function HandCount() {
  const count = store.hands.value.length;
  const set = (n: number) => void studio.command({ command: "hands", count: n });
  return (
    <span class="hand-count">
      <span class="segments is-text" role="radiogroup" aria-label={t("devices.count")}>
      {[1, 2, ...(count > 2 ? [count] : [])].map((n) => (
        <button
          key={n}
          type="button"
          role="radio"
          aria-checked={count === n}
          disabled={!leads(0)}
          data-testid={`hands-${n}`}
          onClick={() => count !== n && set(n)}
        >
          {n > 2 ? t("devices.moreHands", { n }) : t(n === 1 ? "devices.oneHand" : "devices.twoHands")}
        </button>
      ))}
      </span>
      <button type="button" class="small-button" disabled={!leads(0) || count < 2 || count >= kMaxHands} data-testid="add-hand" onClick={() => set(count + 1)}>
        {t("devices.addHand")}
      </button>
    </span>
  );
}

function DeviceRow({ device }: { device: FoundDevice }) {
  const hands = store.hands.value;
  return (
    <li class="device-row">
      <Icon name="device" />
      <div>
        <strong>{device.name}</strong>
        {device.is_emulated ? <span class="badge">{t("devices.emulated")}</span> : null}
        <p class="quiet">{[device.driver, device.detail].filter(Boolean).join(" · ")}</p>
      </div>
      <span class="spacer" />
      {hands.map(({ hand, device: inHand }) =>
        inHand.index === device.index ? (
          <span key={hand} class="badge is-held">
            {t("hands.name", { n: hand + 1 })}
          </span>
        ) : (
          <button
            key={hand}
            type="button"
            class="small-button"
            disabled={!device.is_ready || !leads(hand)}
            aria-label={t("devices.putWhat", { device: device.name, n: hand + 1 })}
            onClick={() => putInto(hand, device.index)}
          >
            {t("devices.put", { n: hand + 1 })}
          </button>
        ),
      )}
    </li>
  );
}

function Rows({ devices }: { devices: readonly FoundDevice[] }) {
  return (
    <ul>
      {devices.map((device) => (
        <DeviceRow key={device.index} device={device} />
      ))}
    </ul>
  );
}

function DeviceList() {
  const list = store.devices.value;
  const isSearching = list?.is_searching === true;
  const emulated = list?.devices.filter((device) => device.is_emulated) ?? [];
  return (
    <section aria-labelledby="devices-found" aria-busy={isSearching}>
      <div class="section-head">
        <h3 id="devices-found">{t("devices.found")}</h3>
        <button type="button" class="small-button" disabled={isSearching} data-testid="search-devices" onClick={() => void search()}>
          {t(isSearching ? "devices.searching" : "devices.search")}
        </button>
      </div>
      {list !== null && list.devices.length === 0 && !isSearching ? <p class="quiet">{t("devices.none")}</p> : null}
      <Rows devices={list?.devices.filter((device) => !device.is_emulated) ?? []} />
      {emulated.length === 0 ? null : (
        <details class="emulated">
          <summary>{t("devices.emulatedTitle", { n: emulated.length })}</summary>
          <Rows devices={emulated} />
        </details>
      )}
    </section>
  );
}

export default function DevicesDialog() {
  useEffect(() => void search(), []);
  return (
    <Dialog title={t("devices.title")} kind="devices" onClose={close}>
      <DialogHead title={t("devices.title")} onClose={close} />
      <div class="dialog-body">
        {store.forcesOff.value ? (
          <p class="note is-bad" role="status">
            <Icon name="stop" size={14} /> {t("banner.forcesOff")}
            <button type="button" class="small-button" disabled={!canSteer()} onClick={() => runAction(findAction("forces-on"))}>
              {t("action.forcesOn")}
            </button>
          </p>
        ) : null}
        <div class="section-head">
          <h3>{t("devices.hands")}</h3>
          <HandCount />
        </div>
        <div class="hand-cards">
          {store.hands.value.map((setup) => (
            <HandCard key={setup.hand} setup={setup} />
          ))}
        </div>
        <DeviceList />
        <section aria-labelledby="devices-rates">
          <h3 id="devices-rates">{t("tabs.rates")}</h3>
          <Rates />
        </section>
      </div>
    </Dialog>
  );
}
