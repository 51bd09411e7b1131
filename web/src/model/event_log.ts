/** Events of the work in the form in which they are told, whether they come now or from a recording. */

import type { RunMetrics, ServerError } from "../protocol/messages";
import { holdStateOf } from "./hints";
import type { LimitCounts, LogEntry, LogKind, Run } from "./store";

/** Bits of haptics::GateAction that a user has to know of: not finite, model late, client silent, device
 lost, buzz, kick. The others limit the force in the course of the work. */
export const kAlarms = 0b1_1001_1100_0001;

const kCloseMm = 10;

export const kLogLength = 200;
export const kRunsLength = 50;

/** As far as events have these. */
export interface WorkEvent {
  event: string;
  occurrence?: number | null;
  state?: number;
  was_seated?: boolean;
  to_place_mm?: number;
  metrics?: RunMetrics;
  reasons?: readonly string[];
  gate_actions?: number;
  off?: boolean;
  on?: boolean;
  file?: string;
  error?: ServerError;
  why?: string | null;
  is_resumed?: boolean;
  seated?: number;
  edits?: number;
}

export interface Told {
  kind: LogKind;
  params: Record<string, string | number>;
}

export function isAlarm(event: { gate_actions?: number }): boolean {
  return ((event.gate_actions ?? 0) & kAlarms) !== 0;
}

/** How far a part is from its place that was let go close to it, for it may look as if it were there. */
function missing(event: WorkEvent): { missing_mm?: number } {
  const mm = event.to_place_mm ?? Infinity;
  return event.was_seated === true || mm > kCloseMm ? {} : { missing_mm: mm };
}

/** Null where the event is nothing to tell. */
export function tell(event: WorkEvent, nameOf: (occurrence: number) => string): Told | null {
  const part = event.occurrence == null ? "" : nameOf(event.occurrence);
  switch (event.event) {
    case "taken":
      return { kind: "taken", params: { part } };
    case "state":
      return part === "" ? null : { kind: "state", params: { part, state: holdStateOf(event.state ?? 0) } };
    case "dropped":
      return { kind: "dropped", params: { part, seated: event.was_seated ? 1 : 0, ...missing(event) } };
    case "safety":
      return event.reasons === undefined || event.reasons.length === 0 || !isAlarm(event)
        ? null
        : { kind: "safety", params: { text: event.reasons.join(", ") } };
    case "forces":
      return { kind: "forces", params: { off: event.off ? 1 : 0 } };
    case "demo":
      return { kind: "demo", params: { on: event.on ? 1 : 0 } };
    case "failed":
      return event.error?.code === "cancelled"
        ? { kind: "stopped", params: { file: event.file ?? "" } }
        : { kind: "failed", params: { text: event.error?.message ?? "" } };
    case "scene":
      return event.why ? { kind: "changed", params: { what: event.why } } : { kind: "opened", params: {} };
    case "resumed": {
      const { seated = 0, edits = 0 } = event;
      return { kind: "resumed", params: { isResumed: event.is_resumed ? 1 : 0, seated, edits } };
    }
    default:
      return null;
  }
}

/** The hand with the limits of the force that an event tells of; the same where it tells of none. */
export function countLimits(counts: LimitCounts, event: WorkEvent): LimitCounts {
  if (event.event !== "safety" || isAlarm(event) || !event.reasons?.length) {
    return counts;
  }
  const next = new Map(counts);
  for (const reason of event.reasons) {
    next.set(reason, (next.get(reason) ?? 0) + 1);
  }
  return next;
}

/** The newest first. An alarm that has been before is counted, in one entry. */
export function addToLog(log: readonly LogEntry[], entry: LogEntry): readonly LogEntry[] {
  const before =
    entry.kind === "safety" ? log.find((each) => each.kind === "safety" && each.params["text"] === entry.params["text"]) : undefined;
  const others = before === undefined ? log : log.filter((each) => each !== before);
  const count = (before?.count ?? 1) + 1;
  return [before === undefined ? entry : { ...entry, count }, ...others].slice(0, kLogLength);
}

/** What a hold of a part came to; null for other events. */
export function runOf(event: WorkEvent, nameOf: (occurrence: number) => string, collisions = 0): Run | null {
  if (event.event !== "dropped" || event.occurrence == null || event.metrics === undefined) {
    return null;
  }
  const { occurrence, metrics } = event;
  return { occurrence, name: nameOf(occurrence), wasSeated: event.was_seated === true, metrics, collisions };
}
