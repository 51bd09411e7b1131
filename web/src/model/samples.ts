/** What the plots show: the last seconds of what a hand felt, read from the store's ring. */

import { kSampleFloats, kSampleSlots, type FrameStore } from "../protocol/frame_store";

export const kWindowS = 8;

export interface PlotWindow {
  /** Seconds before now: negative. */
  time: number[];
  force: [number[], number[], number[]];
  torque: [number[], number[], number[]];
  depthMm: number[];
  tiltDeg: number[];
}

function emptyWindow(): PlotWindow {
  return { time: [], force: [[], [], []], torque: [[], [], []], depthMm: [], tiltDeg: [] };
}

/** The samples of one hand not older than `windowS` before the newest, oldest first. */
export function readWindow(store: FrameStore, hand: number, windowS = kWindowS): PlotWindow {
  const out = emptyWindow();
  const total = store.sampleCount;
  const sample = new Float32Array(kSampleFloats);
  // The oldest slots may be written while they are read.
  const first = Math.max(0, total - kSampleSlots + 8);
  if (total === 0) {
    return out;
  }
  store.readSample(total - 1, sample);
  const now = sample[1] ?? 0;
  for (let index = first; index < total; index++) {
    store.readSample(index, sample);
    const age = now - (sample[1] ?? 0);
    if (sample[0] !== hand || age < 0 || age > windowS) {
      continue;
    }
    out.time.push(-age);
    for (let k = 0; k < 3; k++) {
      out.force[k]?.push(sample[2 + k] ?? 0);
      out.torque[k]?.push(sample[5 + k] ?? 0);
    }
    out.depthMm.push(1e3 * (sample[8] ?? 0));
    out.tiltDeg.push(((sample[9] ?? 0) * 180) / Math.PI);
  }
  return out;
}
