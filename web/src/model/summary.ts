/** What the whole assembly came to (X14, W8). */

import type { Run } from "./store";

export interface AssemblySummary {
  parts: number;
  attempts: number;
  timeS: number;
  pathMm: number;
  peakTrueN: number;
  peakFeltN: number;
  collisions: number;
  slowest: Run | null;
}

/** @param runs  Every hold of a part. */
export function summarizeRuns(runs: readonly Run[]): AssemblySummary {
  const sum = (of: (run: Run) => number) => runs.reduce((total, run) => total + of(run), 0);
  const most = (of: (run: Run) => number) => runs.reduce((best, run) => Math.max(best, of(run)), 0);
  return {
    parts: new Set(runs.filter((run) => run.wasSeated).map((run) => run.occurrence)).size,
    attempts: runs.length,
    timeS: sum((run) => run.metrics.time_s),
    pathMm: sum((run) => run.metrics.path_mm),
    peakTrueN: most((run) => run.metrics.peak_true_n),
    peakFeltN: most((run) => run.metrics.peak_felt_n),
    collisions: sum((run) => run.collisions),
    slowest: runs.reduce<Run | null>((best, run) => (best === null || run.metrics.time_s > best.metrics.time_s ? run : best), null),
  };
}
