/** Counts by size as bars. */

export interface Bar {
  /** Of the times in it [us]; the last bar has no upper end. */
  fromUs: number;
  toUs: number;
  count: number;
  /** Its height, from 0 to 1: by the logarithm, so that a single late tick among a thousand is seen. */
  height: number;
}

/** @param edgesUs  The upper ends of the bins; counts may have one more, of what is beyond them. */
export function makeBars(edgesUs: readonly number[], counts: readonly number[]): Bar[] {
  const most = Math.max(1, ...counts);
  return counts.map((count, k) => ({
    fromUs: k === 0 ? 0 : (edgesUs[k - 1] ?? 0),
    toUs: edgesUs[k] ?? Infinity,
    count,
    height: count === 0 ? 0 : Math.log1p(count) / Math.log1p(most),
  }));
}
