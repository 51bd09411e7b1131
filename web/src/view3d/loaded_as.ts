/** What a product that has been loaded is to the one that was shown before. */

import type { Store } from "../model/store";
import type { ViewState } from "../model/view_state";
import type { Scene } from "../protocol/messages";

/** Completed: the first parts alone were shown until now. */
export type Loaded = "new" | "completed" | "changed";

export function loadedAs(scene: Scene, before: Scene | null): Loaded {
  if (before === null || before.source !== scene.source || before.name !== scene.name) {
    return "new";
  }
  return before.pending > 0 && scene.pending === 0 ? "completed" : "changed";
}

/** Whoever comes to a product that nothing has been done with yet sees it whole first. */
export function opensWhole(scene: Scene, store: Store, view: ViewState): boolean {
  const isUntouched = scene.occurrences.every(({ placement, is_base: isBase }) => isBase || placement !== "placed");
  return isUntouched && !view.isCalm.peek() && store.study.peek() === null && store.replay.peek() === null;
}
