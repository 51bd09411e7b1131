import type { Told } from "../model/event_log";
import type { HoldState } from "../protocol/messages";
import { store } from "./app_state";
import { duration, figures, language, number, t } from "./i18n";
import { seek } from "./time_source";

export function logText(entry: Told): string {
  const p = entry.params;
  switch (entry.kind) {
    case "resumed":
      return t(p["isResumed"] ? "log.resumed" : "log.notResumed", p);
    case "dropped":
      return p["missing_mm"] === undefined
        ? t(p["seated"] ? "log.droppedSeated" : "log.dropped", p)
        : t("log.droppedClose", { ...p, distance: `${figures(Number(p["missing_mm"]), 2)} mm` });
    case "forces":
      return t(p["off"] ? "log.forcesOff" : "log.forcesOn");
    case "demo":
      return t(p["on"] ? "log.demoOn" : "log.demoOff");
    case "recording":
      return t(p["on"] ? "log.recordingOn" : "log.recordingOff", p);
    case "state":
      return t("log.state", { part: p["part"] ?? "", state: t(`state.${p["state"] as HoldState}`) });
    default:
      return t(`log.${entry.kind}`, p);
  }
}

/** Limits of the force come in the course of the work, by the dozen: how often each of them. */
function Limits() {
  const limits = [...store.limits.value];
  return limits.length === 0 ? null : (
    <p class="limit-counts" data-testid="limits">
      {t("log.limits", { text: limits.map(([reason, count]) => `${reason} ${number(count)}×`).join(" · ") })}
    </p>
  );
}

export function EventList() {
  return (
    <>
      <Limits />
      <Events />
    </>
  );
}

function Events() {
  const log = store.log.value;
  if (log.length === 0) {
    return <p class="quiet">{t("log.empty")}</p>;
  }
  const clock = new Intl.DateTimeFormat(language.value, {
    hour: "2-digit",
    minute: "2-digit",
    second: "2-digit",
    hourCycle: "h23",
  });
  return (
    <ol class="events">
      {log.map((entry, k) => (
        <li key={log.length - k} class={`event is-${entry.kind}`}>
          {entry.timeS === undefined ? (
            <time dateTime={entry.at.toISOString()}>{clock.format(entry.at)}</time>
          ) : (
            <button type="button" class="event-time" onClick={() => seek(entry.timeS ?? 0)}>
              {duration(entry.timeS)}
            </button>
          )}
          <span>
            {logText(entry)}
            {entry.count === undefined ? null : ` (${number(entry.count)}×)`}
          </span>
        </li>
      ))}
    </ol>
  );
}
