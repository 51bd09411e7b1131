/** Which stretch of time the plots show. */

import type { HandSetup } from "../protocol/messages";
import type { Trace } from "./trace";

/** From and to, on the clock of what is shown [s]. */
export interface Span {
  fromS: number;
  toS: number;
}

export const kWindowsS = [3, 8, 30, 120, 600] as const;
export const kDefaultWindowS = 8;
/** Shorter than a few samples there is nothing to see [s]. */
export const kLeastS = 0.1;
/** Of a window that goes along with a playback: so much is still to come. */
const kAhead = 0.25;

export interface PlotClock {
  nowS: number;
  /** What there is. */
  beginS: number;
  endS: number;
  isReplay: boolean;
}

/** The clock of what has been traced live: as far as any hand goes back. */
export function liveClock(traces: readonly Pick<Trace, "firstS" | "lastS">[]): PlotClock {
  if (traces.length === 0) {
    return { nowS: 0, beginS: 0, endS: 0, isReplay: false };
  }
  const endS = Math.max(...traces.map((trace) => trace.lastS));
  return { nowS: endS, beginS: Math.min(...traces.map((trace) => trace.firstS)), endS, isReplay: false };
}

/** The hands whose plots can be chosen: those of the scene, or those that a recording has samples of. */
export function plottableHands(hands: readonly Pick<HandSetup, "hand">[], recorded: readonly Pick<Trace, "count">[] | null): number[] {
  return recorded === null ? hands.map(({ hand }) => hand) : recorded.flatMap((trace, hand) => (trace.count > 0 ? [hand] : []));
}

/** @param seconds  The length of a window that goes along with now, or with the moment that is played.
 @param held  The span that somebody chose instead. */
export function rangeOf(seconds: number, held: Span | null, clock: PlotClock): Span {
  if (held !== null) {
    return held;
  }
  if (!clock.isReplay) {
    return { fromS: clock.nowS - seconds, toS: clock.nowS };
  }
  const length = Math.min(seconds, Math.max(kLeastS, clock.endS - clock.beginS));
  const toS = Math.min(clock.endS, Math.max(clock.beginS + length, clock.nowS + kAhead * length));
  return { fromS: toS - length, toS };
}

/** What was marked with the mouse; null where it was too little to be meant. */
export function markedSpan(aS: number, bS: number): Span | null {
  const [fromS, toS] = aS < bS ? [aS, bS] : [bS, aS];
  return toS - fromS < kLeastS ? null : { fromS, toS };
}

/** The span of the same length that ends at a time; null at the end of all there is: the window goes along again. */
export function heldAt(timeS: number, shown: Span, clock: PlotClock): Span | null {
  if (timeS >= clock.endS) {
    return null;
  }
  const toS = Math.max(clock.beginS, timeS);
  return { fromS: toS - (shown.toS - shown.fromS), toS };
}
