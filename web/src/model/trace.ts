/** What a hand felt over time, as columns: kept of the live frames, or made of a recording. */

import { kSampleFloats, kSampleSlots, nowMs, type FrameStore } from "../protocol/frame_store";

/** As `sampleOf` of the store has them. */
export const kTraceFields = [
  "fx_n",
  "fy_n",
  "fz_n",
  "tx_nm",
  "ty_nm",
  "tz_nm",
  "depth_m",
  "tilt_rad",
  "axial_true_n",
  "axial_felt_n",
  "peak_felt_n",
  "state",
  "true_n",
  "contacts",
] as const;
export type TraceField = (typeof kTraceFields)[number];

const kFields = kTraceFields.length;
const fieldAt = Object.fromEntries(kTraceFields.map((name, k) => [name, k])) as Record<TraceField, number>;
/** A clock that steps back further than this is another clock. */
const kOtherClockS = 5;

export class Trace {
  private times = new Float64Array(1024);
  private values = new Float32Array(1024 * kFields);
  private size = 0;

  /** @param keptS  What is older than this, seen from the newest, may be forgotten. */
  constructor(private readonly keptS = Infinity) {}

  get count(): number {
    return this.size;
  }

  get firstS(): number {
    return this.times[0] ?? 0;
  }

  /** 0 while it is empty. */
  get lastS(): number {
    return this.size === 0 ? 0 : (this.times[this.size - 1] ?? 0);
  }

  timeAt(index: number): number {
    return this.times[index] ?? 0;
  }

  valueAt(index: number, field: TraceField): number {
    return this.values[index * kFields + fieldAt[field]] ?? 0;
  }

  /** Adds a sample; what is not newer than the last one is left out. */
  push(timeS: number, sample: ArrayLike<number>, from = 0): void {
    if (this.size > 0 && timeS <= this.lastS) {
      if (timeS > this.lastS - kOtherClockS) {
        return;
      }
      this.size = 0;
    }
    if (this.size === this.times.length) {
      this.makeRoom(timeS);
    }
    this.times[this.size] = timeS;
    for (let k = 0; k < kFields; k++) {
      this.values[this.size * kFields + k] = sample[from + k] ?? 0;
    }
    this.size += 1;
  }

  /** The first sample not before `timeS`. */
  indexAt(timeS: number): number {
    let low = 0;
    let high = this.size;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.times[middle] ?? 0) < timeS) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

  /** Forgets what is too old where that is at least half; else takes twice the memory. */
  private makeRoom(nowS: number): void {
    const kept = this.indexAt(nowS - this.keptS);
    if (2 * kept >= this.size) {
      this.times.copyWithin(0, kept, this.size);
      this.values.copyWithin(0, kept * kFields, this.size * kFields);
      this.size -= kept;
      return;
    }
    const times = new Float64Array(2 * this.times.length);
    const values = new Float32Array(2 * this.values.length);
    times.set(this.times);
    values.set(this.values);
    this.times = times;
    this.values = values;
  }
}

export const kKeptS = 600;
/** The ring tells times of the day modulo this, so that a float can hold them. */
const kRingWrapS = 1e4;

/** The last ten minutes of each hand on the clock of nowMs(), in seconds: taken out of the store's ring before they are overwritten. */
export class LiveTraces {
  private readonly hands = new Map<number, Trace>();
  private read = 0;

  of(hand: number): Trace {
    let trace = this.hands.get(hand);
    if (trace === undefined) {
      trace = new Trace(kKeptS);
      this.hands.set(hand, trace);
    }
    return trace;
  }

  /** Of all hands that have been seen, whatever their number. */
  list(): Trace[] {
    return [...this.hands.values()].filter((trace) => trace.count > 0);
  }

  /** @return Whether there was anything new. */
  follow(store: FrameStore): boolean {
    const total = store.sampleCount;
    if (total === this.read) {
      return false;
    }
    const sample = new Float32Array(kSampleFloats);
    // The oldest slots may be written while they are read.
    for (let index = Math.max(this.read, total - kSampleSlots + 8); index < total; index++) {
      store.readSample(index, sample);
      const ringS = sample[1] ?? 0;
      const turns = Math.round((nowMs() / 1e3 - ringS) / kRingWrapS);
      this.of(sample[0] ?? 0).push(ringS + turns * kRingWrapS, sample, 2);
    }
    this.read = total;
    return true;
  }

}

export interface Series {
  timesS: number[];
  /** One list for each field that was asked for. */
  columns: number[][];
}

/** The samples between two times. Where there are many more than `most`, each stretch of them is told by
 its least and its greatest value, in their order: no peak is lost. */
export function readSeries(trace: Trace, fields: readonly TraceField[], fromS: number, toS: number, most = 2000): Series {
  const first = trace.indexAt(fromS);
  const end = trace.indexAt(toS + 1e-9);
  const stride = Math.ceil((2 * (end - first)) / most);
  const out: Series = { timesS: [], columns: fields.map(() => []) };
  if (stride <= 2) {
    for (let index = first; index < end; index++) {
      out.timesS.push(trace.timeAt(index));
      fields.forEach((field, k) => out.columns[k]!.push(trace.valueAt(index, field)));
    }
    return out;
  }
  // Where a stretch begins does not depend on the window: else the curve would flicker as it moves.
  for (let index = first - (first % stride); index < end; index += stride) {
    const last = Math.min(index + stride, end) - 1;
    out.timesS.push(trace.timeAt(index), trace.timeAt(last));
    fields.forEach((field, k) => {
      out.columns[k]!.push(...extremes((at) => trace.valueAt(at, field), index, last));
    });
  }
  return out;
}

/** The least and the greatest of some values, in their order. */
export function extremes(valueAt: (index: number) => number, first: number, last: number): [number, number] {
  let low = first;
  let high = first;
  for (let index = first + 1; index <= last; index++) {
    const value = valueAt(index);
    low = value < valueAt(low) ? index : low;
    high = value > valueAt(high) ? index : high;
  }
  return low < high ? [valueAt(low), valueAt(high)] : [valueAt(high), valueAt(low)];
}
