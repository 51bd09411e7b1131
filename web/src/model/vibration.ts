/** What a vibrating controller can tell of a force: onsets, slips and seats, and how strong the push is. */

import type { HandState } from "../protocol/frames";

export interface Pulse {
  /** 0 to 1. */
  strength: number;
  ms: number;
}

const kCaptured = 3;
const kMating = 4;
const kSeated = 5;
/** Below this the hand rests [N]. */
const kLeastN = 0.2;
/** The strongest pulse of a push; a device in its place would push back with about as much [N]. */
const kMostN = 8;
/** A pulse takes the place of one that runs, so those of a push are short. */
const kPushMs = 40;
const kPushEveryMs = 30;
/** A fit that sticks and gives way: the axial force falls by this share between two frames. */
const kSlipShare = 0.2;
const kSlipEveryMs = 40;

export const kGrabPulse: Pulse = { strength: 0.8, ms: 40 };
export const kRefusedPulse: Pulse = { strength: 0.3, ms: 120 };
const kContactPulse: Pulse = { strength: 0.6, ms: 20 };
const kCapturePulse: Pulse = { strength: 0.7, ms: 60 };
const kSlipPulse: Pulse = { strength: 0.5, ms: 12 };
const kSeatedPulse: Pulse = { strength: 1, ms: 90 };

type Felt = Pick<HandState, "state" | "contact_count" | "axial_true_n" | "peak_felt_n" | "f_felt_W_n">;

export class Vibration {
  private last: { state: number; contacts: number; axialN: number } | null = null;
  /** What runs is not to be cut short by what says less. */
  private quietUntilMs = -Infinity;
  private slipAfterMs = -Infinity;

  reset(): void {
    this.last = null;
    this.quietUntilMs = -Infinity;
  }

  /** The pulse to give now, if any. */
  next(hand: Felt, nowMs: number): Pulse | null {
    const before = this.last;
    this.last = { state: hand.state, contacts: hand.contact_count, axialN: hand.axial_true_n };
    const event = before === null ? null : this.eventPulse(before, hand, nowMs);
    if (event !== null) {
      this.quietUntilMs = nowMs + event.ms;
      return event;
    }
    const newtons = Math.max(hand.peak_felt_n, Math.hypot(...hand.f_felt_W_n));
    if (newtons < kLeastN || nowMs < this.quietUntilMs) {
      return null;
    }
    this.quietUntilMs = nowMs + kPushEveryMs;
    return { strength: Math.min(1, 0.08 + newtons / kMostN), ms: kPushMs };
  }

  private eventPulse(before: { state: number; contacts: number; axialN: number }, hand: Felt, nowMs: number): Pulse | null {
    if (hand.state === kSeated && before.state !== kSeated) {
      return kSeatedPulse;
    }
    if (hand.state >= kCaptured && before.state < kCaptured) {
      return kCapturePulse;
    }
    const hasSlipped = hand.state === kMating && before.axialN > 1 && hand.axial_true_n < (1 - kSlipShare) * before.axialN;
    if (hasSlipped && nowMs >= this.slipAfterMs) {
      this.slipAfterMs = nowMs + kSlipEveryMs;
      return kSlipPulse;
    }
    return hand.contact_count > 0 && before.contacts === 0 ? kContactPulse : null;
  }
}
