/** The procedure backwards: what is taken out, and in which order (X16). */

import type { Step } from "../protocol/messages";

/** The last that went in comes out first. */
export function takingApart(steps: readonly Step[]): Step[] {
  return steps.filter((step) => step.kind === "insert").reverse();
}

/** The parts that are out after so many of these steps. */
export function takenOut(apart: readonly Step[], count: number): ReadonlySet<number> {
  return new Set(apart.slice(0, count).flatMap((step) => [step.occurrence, ...step.members]));
}
