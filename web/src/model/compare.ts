/** Recordings laid side by side: the same part in each, over time or over depth, and what it cost. */

import type { PartResult, RecordingDetail } from "../protocol/messages";
import type { RecordedRun } from "./playback";
import { extremes, type Trace } from "./trace";

export type Against = "time" | "depth";
export type ForceKind = "felt" | "true";

/** More points than this say nothing more in a picture. */
const kMostPoints = 1500;
/** From this state on a mate guides the part, and its depth is that of insertion. */
const kCaptured = 3;

/** From when to when, and in which hand, something was done. */
export interface Hold {
  hand: number;
  fromS: number;
  toS: number;
}

export interface Curve {
  x: number[];
  y: number[];
}

/** When a part was put into its place; where it never was, its last hold. Null where it was never held.
 @param path  Of the part; null for all of the recording. */
export function findHold(detail: RecordingDetail, path: string | null): Hold | null {
  if (path === null) {
    return { hand: 0, fromS: 0, toS: detail.duration_s };
  }
  const occurrence = detail.results.find((result) => result.path === path)?.occurrence;
  const events = detail.events.filter((event) => event.occurrence === occurrence && occurrence !== undefined);
  let taken: { hand: number; fromS: number } | null = null;
  let found: (Hold & { isSeated: boolean }) | null = null;
  for (const event of events) {
    if (event.event === "taken") {
      taken = { hand: event.hand ?? 0, fromS: event.t_ns / 1e9 };
    } else if (event.event === "dropped" && taken !== null) {
      const isSeated = event.was_seated === true;
      if (isSeated || found?.isSeated !== true) {
        found = { ...taken, toS: event.t_ns / 1e9, isSeated };
      }
      taken = null;
    }
  }
  const stillHeld = taken === null ? null : { ...taken, toS: detail.duration_s };
  return found === null ? stillHeld : { hand: found.hand, fromS: found.fromS, toS: found.toS };
}

function forceAt(trace: Trace, index: number, kind: ForceKind): number {
  return kind === "true"
    ? trace.valueAt(index, "true_n")
    : Math.hypot(trace.valueAt(index, "fx_n"), trace.valueAt(index, "fy_n"), trace.valueAt(index, "fz_n"));
}

/** Few enough points for a picture; no peak is lost. */
function thin(curve: Curve): Curve {
  const stride = Math.ceil((2 * curve.x.length) / kMostPoints);
  if (stride <= 2) {
    return curve;
  }
  const out: Curve = { x: [], y: [] };
  for (let first = 0; first < curve.x.length; first += stride) {
    const last = Math.min(first + stride, curve.x.length) - 1;
    // Two points of one place would be one for the plot.
    const ends = first === last ? [first] : [first, last];
    out.x.push(...ends.map((k) => curve.x[k]!));
    out.y.push(...extremes((k) => curve.y[k]!, first, last).slice(0, ends.length));
  }
  return out;
}

function readHold(run: RecordedRun, hold: Hold, pick: (trace: Trace, index: number) => void): void {
  const trace = run.traces[hold.hand];
  if (trace !== undefined) {
    for (let index = trace.indexAt(hold.fromS); index < trace.indexAt(hold.toS + 1e-9); index++) {
      pick(trace, index);
    }
  }
}

/** Amount of the force [N] over the time since the part was taken [s]. */
export function forceOverTime(run: RecordedRun, hold: Hold, kind: ForceKind): Curve {
  const curve: Curve = { x: [], y: [] };
  readHold(run, hold, (trace, index) => {
    curve.x.push(trace.timeAt(index) - hold.fromS);
    curve.y.push(forceAt(trace, index, kind));
  });
  return thin(curve);
}

/** Depth [mm] over the time since the part was taken [s]. */
export function depthOverTime(run: RecordedRun, hold: Hold): Curve {
  const curve: Curve = { x: [], y: [] };
  readHold(run, hold, (trace, index) => {
    curve.x.push(trace.timeAt(index) - hold.fromS);
    curve.y.push(1e3 * trace.valueAt(index, "depth_m"));
  });
  return thin(curve);
}

/** Amount of the force [N] over the depth [mm] where the part went deeper than it had been: a hand that
 draws back and comes again does not count twice. */
export function forceOverDepth(run: RecordedRun, hold: Hold, kind: ForceKind): Curve {
  const curve: Curve = { x: [], y: [] };
  let deepest = 0;
  readHold(run, hold, (trace, index) => {
    const depth = 1e3 * trace.valueAt(index, "depth_m");
    if (trace.valueAt(index, "state") >= kCaptured && depth > deepest) {
      deepest = depth;
      curve.x.push(depth);
      curve.y.push(forceAt(trace, index, kind));
    }
  });
  return thin(curve);
}

export const kMetrics = ["time_s", "path_m", "peak_true_n", "peak_felt_n", "collisions"] as const;
export type Metric = (typeof kMetrics)[number];
export type Metrics = Readonly<Record<Metric, number>>;

export interface PartRow {
  path: string;
  /** One for each recording; null where it does not have the part. */
  cells: (PartResult | null)[];
}

/** The parts of all recordings, in the order in which they come up. */
export function partRows(details: readonly RecordingDetail[]): PartRow[] {
  const paths = [...new Set(details.flatMap((detail) => detail.results.map((result) => result.path)))];
  return paths.map((path) => ({
    path,
    cells: details.map((detail) => detail.results.find((result) => result.path === path) ?? null),
  }));
}

/** Parts that every one of the recordings has: only they can be compared as a whole. */
export function commonPaths(details: readonly RecordingDetail[]): ReadonlySet<string> {
  const rows = partRows(details).filter(({ cells }) => cells.every((cell) => cell !== null));
  return new Set(rows.map(({ path }) => path));
}

/** The figures of some parts of a recording: times, paths and collisions together, and the greatest of the forces. */
export function totalOf(detail: RecordingDetail, paths: ReadonlySet<string>): Metrics {
  const results = detail.results.filter((result) => paths.has(result.path));
  const of = (metric: Metric) => results.map((result) => result[metric]);
  const sum = (metric: Metric) => of(metric).reduce((total, value) => total + value, 0);
  return {
    time_s: sum("time_s"),
    path_m: sum("path_m"),
    peak_true_n: Math.max(0, ...of("peak_true_n")),
    peak_felt_n: Math.max(0, ...of("peak_felt_n")),
    collisions: sum("collisions"),
  };
}

/** How much more than the first [%]; null where there is nothing to compare with. */
export function differencePercent(value: number, first: number): number | null {
  if (first === 0) {
    return value === 0 ? 0 : null;
  }
  return 100 * (value / first - 1);
}
