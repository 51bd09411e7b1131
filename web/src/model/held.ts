/** What the frames say of the hands, as far as it is for words and lists. */

import { kNone, type HandState } from "../protocol/frames";
import { holdStateOf } from "./hints";
import type { HeldSummary } from "./store";

export function summarize(hands: readonly HandState[]): HeldSummary[] {
  return hands
    .filter((h) => h.occurrence !== kNone && h.state !== 0)
    .map((h) => ({
      hand: h.hand,
      occurrence: h.occurrence,
      state: holdStateOf(h.state),
      mate: h.mate === kNone ? null : h.mate,
    }));
}

export function isSameHeld(a: readonly HeldSummary[], b: readonly HeldSummary[]): boolean {
  return (
    a.length === b.length &&
    a.every((h, k) => {
      const other = b[k];
      return (
        other?.hand === h.hand && other.occurrence === h.occurrence && other.state === h.state && other.mate === h.mate
      );
    })
  );
}
