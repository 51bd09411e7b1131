/** Where the plots and the timeline have their time and their samples from: live, or of a recording. */

import { heldAt, liveClock, plottableHands, rangeOf, type PlotClock, type Span } from "../model/plot_range";
import type { Trace } from "../model/trace";
import { liveTraces, store, studio, ui, viewport } from "./app_state";

export function traceOf(hand: number): Trace {
  const playback = studio.recordings.playback.peek();
  return playback?.run.traces[hand] ?? liveTraces.of(hand);
}

export function plotClock(): PlotClock {
  const playback = studio.recordings.playback.peek();
  if (playback !== null) {
    return { nowS: playback.timeS, beginS: 0, endS: playback.durationS, isReplay: true };
  }
  return liveClock(liveTraces.list());
}

/** The hands that the plots can show: those that are there, or those of the recording. */
export function plotHands(): number[] {
  return plottableHands(store.hands.value, studio.recordings.playback.value?.run.traces ?? null);
}

/** The hand whose forces are plotted: the chosen one while it is there. */
export function plottedHand(): number {
  const hands = plotHands();
  return hands.includes(ui.plotHand.value) ? ui.plotHand.value : (hands[0] ?? 0);
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
