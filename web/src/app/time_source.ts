/** Where the plots and the timeline have their time and their samples from: live, or of a recording. */

import { heldAt, rangeOf, type PlotClock, type Span } from "../model/plot_range";
import type { Trace } from "../model/trace";
import { liveTraces, studio, ui, viewport } from "./app_state";

const kNothing: PlotClock = { nowS: 0, beginS: 0, endS: 0, isReplay: false };

export function traceOf(hand: number): Trace {
  const playback = studio.recordings.playback.peek();
  return playback?.run.traces[hand] ?? liveTraces.of(hand);
}

export function plotClock(): PlotClock {
  const playback = studio.recordings.playback.peek();
  if (playback !== null) {
    return { nowS: playback.timeS, beginS: 0, endS: playback.durationS, isReplay: true };
  }
  const traces = [0, 1].map((hand) => liveTraces.of(hand)).filter((trace) => trace.count > 0);
  if (traces.length === 0) {
    return kNothing;
  }
  const endS = Math.max(...traces.map((trace) => trace.lastS));
  return { nowS: endS, beginS: Math.min(...traces.map((trace) => trace.firstS)), endS, isReplay: false };
}

/** What the plots show now. */
export function shownSpan(): Span {
  return rangeOf(ui.plotSeconds.peek(), ui.plotSpan.peek(), plotClock());
}

/** To a moment: of the recording, or of the plots of the last minutes. */
export function seek(timeS: number): void {
  const playback = studio.recordings.playback.peek();
  if (playback !== null) {
    playback.seek(timeS);
  } else {
    ui.plotSpan.value = heldAt(timeS, shownSpan(), plotClock());
  }
}

/** Opens a recording in place of what is live. */
export async function openRecording(id: string, timeS = 0): Promise<void> {
  viewport.value?.hand.releaseAll();
  if (await studio.recordings.open(id, timeS)) {
    ui.plotSpan.value = null;
  }
}

/** Back from a recording, or from plots that were held back. */
export function backToLive(): void {
  studio.recordings.close();
  ui.plotSpan.value = null;
}
