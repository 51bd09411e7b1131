/** Orders of assembly that the user tries out. */

import type { OrderedMove, Step } from "../protocol/messages";

/** The steps whose order may change; what is put together by itself and the base come first, as they are. */
export function movableSteps(steps: readonly Step[]): Step[] {
  const lastParked = steps.map((step) => step.kind).lastIndexOf("park");
  return steps.slice(lastParked + 1).filter((step) => step.kind === "insert");
}

/** The steps as moves of which nothing is known yet. */
export function movesOf(steps: readonly Step[]): OrderedMove[] {
  return movableSteps(steps).map((step) => ({
    occurrence: step.occurrence,
    members: step.members.filter((id) => id !== step.occurrence),
    blocked_by: [],
    in_tool_space: [],
    holds: null,
  }));
}

/** The list with the item `from` at the place `to`. */
export function withMoved<T>(items: readonly T[], from: number, to: number): T[] {
  const place = Math.max(0, Math.min(items.length - 1, to));
  const rest = items.filter((_, k) => k !== from);
  return [...rest.slice(0, place), ...items.slice(from, from + 1), ...rest.slice(place)];
}

/** Where an item goes that is dragged to the height y, among rows that lie around these heights. */
export function placeAt(middles: readonly number[], from: number, y: number): number {
  return middles.filter((middle, k) => k !== from && middle < y).length;
}
