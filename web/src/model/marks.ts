/** What happened when, as marks on a timeline. */

import { tell, type Told } from "./event_log";
import type { LogEntry } from "./store";
import type { Trace } from "./trace";
import type { RecordedEvent } from "../protocol/messages";

export type MarkKind = "taken" | "contact" | "captured" | "seated" | "dropped" | "safety";

export interface Mark {
  timeS: number;
  kind: MarkKind;
  /** In words; of a contact there is nothing more to say. */
  told: Told | null;
}

/** A hand that has touched nothing for this long touches anew [s]. */
const kApartS = 0.5;

function kindOf(told: Told): MarkKind | null {
  switch (told.kind) {
    case "taken":
    case "dropped":
    case "safety":
      return told.kind;
    case "state":
      return told.params["state"] === "captured" || told.params["state"] === "seated" ? told.params["state"] : null;
    default:
      return null;
  }
}

function markOf(timeS: number, told: Told | null): Mark[] {
  const kind = told === null ? null : kindOf(told);
  return kind === null ? [] : [{ timeS, kind, told }];
}

/** When something was touched that had not been touched for a while. */
export function contactTimes(trace: Trace): number[] {
  const times: number[] = [];
  let touchedS = -Infinity;
  for (let k = 0; k < trace.count; k++) {
    if (trace.valueAt(k, "contacts") > 0) {
      const timeS = trace.timeAt(k);
      if (timeS - touchedS > kApartS) {
        times.push(timeS);
      }
      touchedS = timeS;
    }
  }
  return times;
}

function contactMarks(traces: readonly Trace[]): Mark[] {
  return traces.flatMap(contactTimes).map((timeS) => ({ timeS, kind: "contact", told: null }));
}

const byTime = (a: Mark, b: Mark) => a.timeS - b.timeS;

export function recordedMarks(
  events: readonly RecordedEvent[],
  traces: readonly Trace[],
  nameOf: (occurrence: number) => string,
): Mark[] {
  const told = events.flatMap((event) => markOf(event.t_ns / 1e9, tell(event, nameOf)));
  return [...told, ...contactMarks(traces)].sort(byTime);
}

/** Of the last minutes, on the clock of nowMs() in seconds. */
export function liveMarks(log: readonly LogEntry[], traces: readonly Trace[]): Mark[] {
  const told = log.flatMap((entry) => markOf(entry.at.getTime() / 1e3, entry));
  return [...told, ...contactMarks(traces)].sort(byTime);
}
