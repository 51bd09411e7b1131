/** Counts how often a free part runs into something: from contact after none, before a mate has it. */

import { kNone, type HandState } from "../protocol/frames";

const kFree = 1;
const kNear = 2;

export class CollisionCounter {
  private readonly counts = new Map<number, { occurrence: number; count: number; isTouching: boolean }>();

  note(hands: readonly Pick<HandState, "hand" | "occurrence" | "state" | "contact_count">[]): void {
    for (const { hand, occurrence, state, contact_count } of hands) {
      if (occurrence === kNone) {
        continue;
      }
      let at = this.counts.get(hand);
      if (at?.occurrence !== occurrence) {
        // What lies on the table touches it as it is taken up: that is none.
        at = { occurrence, count: 0, isTouching: true };
        this.counts.set(hand, at);
      }
      const isTouching = contact_count > 0;
      const isFree = state === kFree || state === kNear;
      at.count += isFree && isTouching && !at.isTouching ? 1 : 0;
      at.isTouching = isTouching;
    }
  }

  /** Of the hold that has ended; a new count begins. */
  take(hand: number): number {
    const { count } = this.counts.get(hand) ?? { count: 0 };
    this.counts.delete(hand);
    return count;
  }
}
