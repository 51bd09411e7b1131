import type { Told } from "../model/event_log";
import type { HoldState } from "../protocol/messages";
import { store, ui, type EventFilter } from "./app_state";
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
      return t(`log.state.${p["state"] as HoldState}`, { part: p["part"] ?? "" });
    default:
      return t(`log.${entry.kind}`, p);
  }
}

/** Limits of the force come in the course of the work, by the dozen. They are no events for who assembles: how often
 there was one, and on demand each of them. */
function Limits() {
  const limits = [...store.limits.value];
  const count = limits.reduce((sum, [, times]) => sum + times, 0);
  return limits.length === 0 ? null : (
    <details class="limit-counts" data-testid="limits">
      <summary>{t("log.limits", { n: number(count) })}</summary>
      <ul>
        {limits.map(([reason, times]) => (
          <li key={reason}>
            {reason} {number(times)}×
          </li>
        ))}
      </ul>
    </details>
  );
}

const kParts: readonly Told["kind"][] = ["taken", "dropped", "state"];
const kAlarms: readonly Told["kind"][] = ["safety", "forces", "failed"];
const kFilters: Record<EventFilter, (kind: Told["kind"]) => boolean> = {
  all: () => true,
  parts: (kind) => kParts.includes(kind),
  alarms: (kind) => kAlarms.includes(kind),
};

function Filter() {
  return (
    <select
      class="event-filter"
      aria-label={t("log.filter")}
      data-testid="event-filter"
      value={ui.eventFilter.value}
      onChange={(event) => (ui.eventFilter.value = event.currentTarget.value as EventFilter)}
    >
      {(Object.keys(kFilters) as EventFilter[]).map((name) => (
        <option key={name} value={name}>
          {t(`log.filter.${name}`)}
        </option>
      ))}
    </select>
  );
}

export function EventList() {
  return (
    <>
      {store.log.value.length > 0 ? <Filter /> : null}
      <Limits />
      <Events />
    </>
  );
}

function Events() {
  const log = store.log.value.filter(({ kind }) => kFilters[ui.eventFilter.value](kind));
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
