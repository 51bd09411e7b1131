/** The guide through the first part that somebody puts in by hand: three steps, each of which goes when it is done. */

import type { HoldState } from "../protocol/messages";

export const kGuideSteps = ["take", "bring", "push"] as const;
export type GuideStep = (typeof kGuideSteps)[number];

/** Counts the steps that are done.
 @param state     Of the part in the hand.
 @param isPlaced  Whether the part that was in the hand last is in its place. */
export function countDone(state: HoldState, isPlaced: boolean): number {
  if (isPlaced) {
    return kGuideSteps.length;
  }
  const done: Record<HoldState, number> = { empty: 0, free: 1, near: 2, captured: 2, mating: 2, seated: 3 };
  return done[state];
}

/** So many steps are done, of which so many are not shown any more. */
export interface Guidance {
  done: number;
  gone: number;
}

export const kGuideBegin: Guidance = { done: 0, gone: 0 };

/** What follows when so many steps are done. A part that slips out of the hand brings its step back. */
export function follow(before: Guidance, done: number): Guidance {
  return { done, gone: Math.min(before.gone, done) };
}

/** What follows when the ticks of the steps that are done have been seen. */
export function dropTicked({ done }: Guidance): Guidance {
  return { done, gone: done };
}

/** The steps that are shown, numbered from 1. */
export function shownSteps({ done, gone }: Guidance): { step: GuideStep; number: number; isDone: boolean; isNext: boolean }[] {
  return kGuideSteps
    .map((step, k) => ({ step, number: k + 1, isDone: k < done, isNext: k === done }))
    .slice(gone);
}
