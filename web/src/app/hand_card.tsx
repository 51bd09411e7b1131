/** One hand: what moves it, how that is, and who leads it. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { forceShare, kPointer, leaderOf, parseScale } from "../model/hands";
import type { HandSetup } from "../protocol/messages";
import { store, studio } from "./app_state";
import { deviceName } from "./device_name";
import type { MessageKey } from "./en";
import { figures, number, t } from "./i18n";
import { Icon } from "./icons";
import { clientName } from "./people";

/** Also while a recording is looked at: hands are live. */
export const leads = (hand: number) => store.link.value === "open" && store.ownHands.value.includes(hand);

/** @param scale  Scene length for one of the device; 0: by their sizes. */
export function putInto(hand: number, device: number, scale = 0): void {
  void studio.command({ command: "use", hand, device, scale });
}

/** The force now against the most that there may be. */
function ForceNow({ setup }: { setup: HandSetup }) {
  const fill = useRef<HTMLElement>(null);
  const status = store.status.value?.hands?.find((each) => each.hand === setup.hand);
  const most = setup.device.max_force_n;
  useEffect(() => {
    if (fill.current !== null) {
      fill.current.style.transform = `scaleX(${forceShare(status?.force_n ?? 0, most)})`;
    }
  });
  if (!setup.device.has_force) {
    return (
      <>
        <dt>{t("devices.force")}</dt>
        <dd>{t("devices.noForce")}</dd>
      </>
    );
  }
  const limit = most === null ? "–" : number(most, 1);
  return (
    <>
      <dt>{t("devices.force")}</dt>
      <dd>
        {status === undefined ? "–" : figures(status.force_n)} / {limit} N
        <span class="progress is-line" aria-hidden="true">
          <i ref={fill} />
        </span>
      </dd>
      {setup.device.has_torque ? <dt>{t("devices.torque")}</dt> : null}
      {setup.device.has_torque ? <dd>{status === undefined ? "–" : `${figures(1e3 * status.torque_nm)} mN m`}</dd> : null}
      <dt>{t("devices.energy")}</dt>
      <dd>{status === undefined ? "–" : `${figures(1e3 * status.energy_j)} mJ`}</dd>
    </>
  );
}

function ScaleField({ setup }: { setup: HandSetup }) {
  const text = useSignal("");
  const scale = parseScale(text.value);
  const apply = (event: Event) => {
    event.preventDefault();
    if (scale !== null) {
      putInto(setup.hand, setup.device.index, scale);
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
function Lease({ hand }: { hand: number }) {
  const leader = leaderOf(store.clients.value, hand);
  const isOwn = leader !== null && leader.id === store.client.value;
  const others = store.clients.value.filter((c) => c.role === "operator" && c.id !== store.client.value);
  const act = (action: "request" | "release" | "give", to?: string) =>
    void studio.command({ command: "lease", action, hand, ...(to === undefined ? {} : { to }) });
  return (
    <div class="lease-row">
      <span>
        {leader === null
          ? t("devices.ledByNone")
          : isOwn
            ? t("devices.ledByYou")
            : t("devices.ledBy", { client: clientName(leader.id) })}
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
              {clientName(client.id)}
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

const kConditions: Readonly<Record<string, MessageKey>> = {
  ready: "condition.ready",
  "no-force": "condition.noForce",
  "not-held": "condition.notHeld",
  "not-calibrated": "condition.notCalibrated",
  stale: "condition.stale",
  implausible: "condition.implausible",
  lost: "condition.lost",
  stopped: "condition.stopped",
  fault: "condition.fault",
};

function conditionText(condition: string): string {
  const key = kConditions[condition];
  return key === undefined ? condition : t(key);
}

export function HandCard({ setup }: { setup: HandSetup }) {
  const { device, condition } = setup;
  const isReady = condition === "ready";
  const trouble = store.deviceTroubles.value.get(setup.hand);
  return (
    <section class="card hand-card" aria-label={t("hands.name", { n: setup.hand + 1 })} data-testid={`hand-${setup.hand}`}>
      <h3>
        {t("hands.name", { n: setup.hand + 1 })}
        <span class={`badge ${isReady ? "is-done" : "is-next"}`}>{conditionText(condition)}</span>
      </h3>
      <p class="device-name">
        <strong>{deviceName(setup)}</strong>
        {device.is_emulated ? <span class="badge">{t("devices.emulated")}</span> : null}
      </p>
      {trouble === undefined ? null : (
        <p class="note is-bad">
          <Icon name="warn" size={14} /> {trouble}
        </p>
      )}
      <dl class="facts">
        <dt>{t("devices.model")}</dt>
        <dd>{[device.model, device.serial].filter(Boolean).join(" · ")}</dd>
        <dt>{t("devices.scaleNow")}</dt>
        <dd>{device.scale === null ? "–" : `${figures(device.scale)} ×`}</dd>
        <ForceNow setup={setup} />
      </dl>
      {device.notes.map((note) => (
        <p key={note} class="note">
          <Icon name="warn" size={14} /> {note}
        </p>
      ))}
      {device.index === kPointer ? null : (
        <>
          <ScaleField setup={setup} />
          <button
            type="button"
            class="small-button"
            disabled={!leads(setup.hand)}
            data-testid={`to-mouse-${setup.hand}`}
            onClick={() => putInto(setup.hand, kPointer)}
          >
            {t("devices.toMouse")}
          </button>
        </>
      )}
      <Lease hand={setup.hand} />
    </section>
  );
}
