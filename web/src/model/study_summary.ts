/** The trials so far, in numbers. */

import type { FinishedTrial } from "../protocol/messages";

export interface MeanTime {
  condition: string;
  /** Trials that were done. */
  count: number;
  /** Null while none was. */
  meanS: number | null;
}

/** By condition, in the order of their first trials; those that were not done have no time. */
export function meanTimes(trials: readonly FinishedTrial[]): MeanTime[] {
  const times = new Map<string, number[]>();
  for (const { condition, outcome, time_s } of trials) {
    const known = times.get(condition) ?? [];
    times.set(condition, outcome === "done" && time_s !== null ? [...known, time_s] : known);
  }
  return [...times].map(([condition, each]) => ({
    condition,
    count: each.length,
    meanS: each.length === 0 ? null : each.reduce((sum, time) => sum + time, 0) / each.length,
  }));
}
