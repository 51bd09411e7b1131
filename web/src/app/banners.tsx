/** What must not be missed, and what was said last. */

import { useEffect } from "preact/hooks";
import { findAction, runAction } from "./actions";
import { canSteer, store, studio } from "./app_state";
import { logText } from "./event_list";
import { PartAsked } from "./hand_over";
import { clientName, FollowedBanner } from "./people";
import { t } from "./i18n";
import { Icon } from "./icons";
import { backToLive } from "./time_source";

const kNoticeMs = 5000;

/** Why the studio lets this page in no more, or never has. */
export function denialText(): string {
  const { denial } = store;
  return denial.value === null ? t("empty.denied") : `${denial.value.message}: ${denial.value.remedy}.`;
}

export function Banners() {
  const safety = store.safety.value;
  const asked = store.leaseAsked.value;
  return (
    <div class="banners">
      {store.link.value === "lost" ? (
        <div class="banner is-bad" role="alert">
          <Icon name="warn" /> {t("banner.lost")}
        </div>
      ) : null}
      {store.link.value === "denied" && store.scene.value !== null ? (
        <div class="banner is-bad" role="alert" data-testid="denied">
          <Icon name="lock" /> {denialText()}
        </div>
      ) : null}
      {store.isSilent.value && store.link.value === "open" ? (
        <div class="banner is-bad" role="alert" data-testid="silent">
          <Icon name="warn" /> {t("banner.silent")}
        </div>
      ) : null}
      {safety !== null ? (
        <div class="banner is-bad" role="alert" data-testid="safety">
          <Icon name="warn" />
          <span>{t("banner.safety", { reasons: safety.reasons.join(", ") })}</span>
          <button type="button" class="banner-button" onClick={() => (store.safety.value = null)}>
            {t("banner.dismiss")}
          </button>
        </div>
      ) : null}
      {store.forcesOff.value && store.link.value === "open" ? (
        <div class="banner is-bad" role="alert" data-testid="forces-are-off">
          <Icon name="stop" />
          <span>{t("banner.forcesOff")}</span>
          {canSteer() ? (
            <button type="button" class="banner-button" onClick={() => runAction(findAction("forces-on"))}>
              {t("action.forcesOn")}
            </button>
          ) : null}
        </div>
      ) : null}
      {[...store.deviceTroubles.value].map(([hand, text]) => (
        <div class="banner is-bad" role="alert" key={hand} data-testid={`device-trouble-${hand}`}>
          <Icon name="warn" />
          <span>{t("banner.device", { n: hand + 1, text })}</span>
          <button type="button" class="banner-button" onClick={() => runAction(findAction("devices"))}>
            {t("devices.title")}
          </button>
        </div>
      ))}
      <PlayingBanner />
      {asked !== null ? (
        <div class="banner is-info" role="alert" data-testid="lease-asked">
          <Icon name="hand" />
          <span>
            {asked.hands.length === 1
              ? t("people.handAsked", { name: clientName(asked.by), n: (asked.hands[0] ?? 0) + 1 })
              : t("people.controlAsked", { name: clientName(asked.by) })}
          </span>
          <button type="button" class="banner-button" onClick={() => runAction(findAction("lease-give"))}>
            {t("banner.give")}
          </button>
          <button type="button" class="banner-button" onClick={() => (store.leaseAsked.value = null)}>
            {t("banner.keep")}
          </button>
        </div>
      ) : null}
      <PartAsked />
      <FollowedBanner />
      {store.demo.value ? (
        <div class="banner is-info" data-testid="demo-runs">
          <Icon name="play" />
          <span>{t("banner.demo")}</span>
          {canSteer() ? (
            <button type="button" class="banner-button" onClick={() => runAction(findAction("demo"))}>
              {t("banner.stop")}
            </button>
          ) : null}
        </div>
      ) : null}
    </div>
  );
}

/** What is seen is not what is. */
function PlayingBanner() {
  const { playback, fetching } = studio.recordings;
  const name = playback.value?.run.detail.name;
  if (fetching.value !== null) {
    return (
      <div class="banner is-info" role="status">
        {t("banner.fetching", { name: fetching.value })}
      </div>
    );
  }
  return name === undefined ? null : (
    <div class="banner is-info" data-testid="playing">
      <Icon name="play" />
      <span>{t("banner.playing", { name })}</span>
      <button type="button" class="banner-button" data-testid="back-to-live" onClick={backToLive}>
        {t("action.live")}
      </button>
    </div>
  );
}

export function Notice() {
  const notice = store.notice.value;
  useEffect(() => {
    const timer = setTimeout(() => (store.notice.value = null), kNoticeMs);
    return () => clearTimeout(timer);
  }, [notice?.id]);
  return (
    <div class="notices" role="status" aria-live="polite">
      {notice !== null ? (
        <div class={`notice ${notice.isError ? "is-bad" : ""}`} data-testid="notice">
          {notice.text}
          <button type="button" class="eye-button" aria-label={t("dialog.close")} onClick={() => (store.notice.value = null)}>
            <Icon name="close" size={14} />
          </button>
        </div>
      ) : null}
    </div>
  );
}

/** For those who do not see the picture: each event in words. */
export function LiveRegion() {
  const last = store.log.value[0];
  return (
    <p class="sr-only" role="log" aria-live="polite">
      {last === undefined ? "" : logText(last)}
    </p>
  );
}

export function useStatusPolling(): void {
  useEffect(() => {
    if (store.link.value === "open" && store.status.value === null) {
      void studio.command({ command: "status" });
    }
  }, [store.link.value]);
}
