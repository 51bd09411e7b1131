/** Who leads which hand, and with what. */

import type { HandSetup, HandStatus } from "../protocol/recording_messages";

export const kPointer = "pointer";

/** May the mouse of this page move the hand? */
export function isPointerHand(hands: readonly HandSetup[], own: readonly number[], hand: number): boolean {
  const setup = hands.find((each) => each.hand === hand);
  // A server that says nothing of hands has one, for the pointer.
  const isThere = setup === undefined ? hand === 0 && hands.length === 0 : setup.device.address === kPointer;
  return isThere && own.includes(hand);
}

/** How much of what may be is there now, from 0 to 1. */
export function forceShare(status: HandStatus): number {
  return status.limit_n > 0 ? Math.min(1, Math.max(0, status.force_n / status.limit_n)) : 0;
}

/** What the device of a hand is told to do: 0 for the scale of its profile. Null for what is no number. */
export function parseScale(text: string): number | null {
  const trimmed = text.trim().replace(",", ".");
  if (trimmed === "") {
    return 0;
  }
  const value = Number(trimmed);
  return Number.isFinite(value) && value > 0 && value <= 100 ? value : null;
}
