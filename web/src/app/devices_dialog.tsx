/** The hands, what each of them is, and the devices that could be. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { forceShare, kPointer, parseScale } from "../model/hands";
import type { FoundDevice, HandSetup } from "../protocol/recording_messages";
import { findAction, runAction } from "./actions";
import { canSteer, store, studio, ui } from "./app_state";
import { Dialog, DialogHead } from "./dialog";
import { figures, number, t } from "./i18n";
import { Icon } from "./icons";
import { Rates } from "./rates";

const close = () => (ui.overlay.value = null);
/** Also while a recording is looked at: hands are live. */
const leads = (hand: number) => store.link.value === "open" && store.ownHands.value.includes(hand);

async function search(): Promise<void> {
  const list = await studio.command({ command: "devices" });
  if (list !== null) {
    store.devices.value = list;
  }
}

function use(hand: number, device: string, scale = 0): void {
  void studio.command({ command: "use", hand, device, scale });
}

/** The force now against the most that there may be. */
function ForceBar({ hand }: { hand: number }) {
  const fill = useRef<HTMLElement>(null);
  const status = store.status.value?.hands?.find((each) => each.hand === hand);
  useEffect(() => {
    if (fill.current !== null && status !== undefined) {
      fill.current.style.transform = `scaleX(${forceShare(status)})`;
    }
  });
  if (status === undefined) {
    return null;
  }
  return (
    <>
      <dt>{t("devices.force")}</dt>
      <dd>
        {figures(status.force_n)} / {number(status.limit_n, 1)} N
        <span class="progress is-line" aria-hidden="true">
          <i ref={fill} />
        </span>
      </dd>
      <dt>{t("devices.speed")}</dt>
      <dd>{figures(status.speed_m_s)} m/s</dd>
      <dt>{t("devices.energy")}</dt>
      <dd>{figures(1e3 * status.energy_j)} mJ</dd>
    </>
  );
}

function ScaleField({ setup }: { setup: HandSetup }) {
  const text = useSignal("");
  const scale = parseScale(text.value);
  const apply = (event: Event) => {
    event.preventDefault();
    if (scale !== null) {
      use(setup.hand, setup.device.address, scale);
    }
  };
  return (
    <form class="scale-form" onSubmit={apply}>
      <label>
        {t("devices.scale")}
        <input
          inputMode="decimal"
          value={text.value}
          placeholder={t("devices.scaleAuto")}
          title={t("devices.scaleHelp")}
          aria-invalid={scale === null}
          onInput={(event) => (text.value = event.currentTarget.value)}
        />
      </label>
      <button type="submit" class="small-button" disabled={scale === null || !leads(setup.hand)}>
        {t("fit.apply")}
      </button>
    </form>
  );
}

/** Who leads the hand, and how it goes to somebody else. */
function Lease({ setup }: { setup: HandSetup }) {
  const { hand, lease } = setup;
  const isOwn = lease !== null && lease === store.client.value;
  const others = store.clients.value.filter((c) => c.role === "operator" && c.id !== store.client.value);
  const act = (action: "request" | "release" | "give", to?: string) =>
    void studio.command({ command: "lease", action, hand, ...(to === undefined ? {} : { to }) });
  return (
    <div class="lease-row">
      <span>
        {lease === null
          ? t("devices.ledByNone")
          : isOwn
            ? t("devices.ledByYou")
            : t("devices.ledBy", { client: lease })}
      </span>
      <span class="spacer" />
      {isOwn && others.length > 0 ? (
        <select
          aria-label={t("devices.give", { n: hand + 1 })}
          value=""
          onChange={(event) => event.currentTarget.value !== "" && act("give", event.currentTarget.value)}
        >
          <option value="">{t("devices.giveTo")}</option>
          {others.map((client) => (
            <option key={client.id} value={client.id}>
              {client.id}
            </option>
          ))}
        </select>
      ) : null}
      {!isOwn && store.role.value === "operator" ? (
        <button type="button" class="small-button" onClick={() => act("request")}>
          {t("action.lease")}
        </button>
      ) : null}
    </div>
  );
}

function conditionText(condition: string): string {
  const known = { ready: "devices.ready", not_held: "devices.notHeld", "not held": "devices.notHeld" } as const;
  return condition in known ? t(known[condition as keyof typeof known]) : condition;
}

function HandCard({ setup }: { setup: HandSetup }) {
  const { device, condition } = setup;
  const isReady = condition === "ready";
  return (
    <section class="card hand-card" aria-label={t("hands.name", { n: setup.hand + 1 })} data-testid={`hand-${setup.hand}`}>
      <h3>
        {t("hands.name", { n: setup.hand + 1 })}
        <span class={`badge ${isReady ? "is-done" : "is-next"}`}>{conditionText(condition)}</span>
      </h3>
      <p class="device-name">
        <strong>{device.address === kPointer ? t("devices.mouse") : device.name}</strong>
        {device.is_emulated ? <span class="badge">{t("devices.emulated")}</span> : null}
      </p>
      <dl class="facts">
        <dt>{t("devices.model")}</dt>
        <dd>{device.model || "–"}</dd>
        <dt>{t("devices.most")}</dt>
        <dd>{device.has_force ? `${number(device.max_force_n, 1)} N` : t("devices.noForce")}</dd>
        <dt>{t("devices.scaleNow")}</dt>
        <dd>{figures(device.scale)} ×</dd>
        <ForceBar hand={setup.hand} />
      </dl>
      {device.notes.map((note) => (
        <p key={note} class="note">
          <Icon name="warn" size={14} /> {note}
        </p>
      ))}
      {device.address === kPointer ? null : (
        <>
          <ScaleField setup={setup} />
          <button
            type="button"
            class="small-button"
            disabled={!leads(setup.hand)}
            data-testid={`to-mouse-${setup.hand}`}
            onClick={() => use(setup.hand, kPointer)}
          >
            {t("devices.toMouse")}
          </button>
        </>
      )}
      <Lease setup={setup} />
    </section>
  );
}

function HandCount() {
  const count = store.hands.value.length;
  return (
    <span class="segments is-text" role="radiogroup" aria-label={t("devices.count")}>
      {[1, 2].map((n) => (
        <button
          key={n}
          type="button"
          role="radio"
          aria-checked={count === n}
          disabled={!leads(0)}
          data-testid={`hands-${n}`}
          onClick={() => count !== n && void studio.command({ command: "hands", count: n })}
        >
          {t(n === 1 ? "devices.oneHand" : "devices.twoHands")}
        </button>
      ))}
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
        inHand.address === device.address ? (
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
            onClick={() => use(hand, device.address)}
          >
            {t("devices.put", { n: hand + 1 })}
          </button>
        ),
      )}
    </li>
  );
}

function DeviceList() {
  const list = store.devices.value;
  const isSearching = list?.is_searching === true;
  return (
    <section aria-labelledby="devices-found" aria-busy={isSearching}>
      <div class="section-head">
        <h3 id="devices-found">{t("devices.found")}</h3>
        <button type="button" class="small-button" disabled={isSearching} data-testid="search-devices" onClick={() => void search()}>
          {t(isSearching ? "devices.searching" : "devices.search")}
        </button>
      </div>
      {list !== null && list.devices.length === 0 && !isSearching ? <p class="quiet">{t("devices.none")}</p> : null}
      <ul>
        {list?.devices.map((device) => <DeviceRow key={device.address} device={device} />)}
      </ul>
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
