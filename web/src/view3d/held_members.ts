/** What was put together on the table with a part that is in a hand, and goes with it. */

import { compose, inverse, type Pose } from "../model/math";
import type { Store } from "../model/store";

export function heldWith(store: Store, leader: number): number[] {
  return [...store.heldBy.peek()].filter(([id, held]) => held.occurrence === leader && id !== leader).map(([id]) => id);
}

/** Poses of a held part, when it is at `pose`, and of what goes with it, as drawn. */
export function posesInHand(store: Store, leader: number, pose: Pose): (readonly [number, Pose])[] {
  const goalOf = (id: number) => store.occurrences.peek().get(id)?.goal;
  const goal = goalOf(leader);
  const members = heldWith(store, leader).flatMap((member) => {
    const drawn = goalOf(member);
    return goal === undefined || drawn === undefined ? [] : [[member, compose(pose, compose(inverse(goal), drawn))] as const];
  });
  return [[leader, pose], ...members];
}
