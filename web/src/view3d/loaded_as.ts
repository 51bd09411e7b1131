/** What a product that has been loaded is to the one that was shown before. */

import type { Scene } from "../protocol/messages";

/** Completed: the first parts alone were shown until now. */
export type Loaded = "new" | "completed" | "changed";

export function loadedAs(scene: Scene, before: Scene | null): Loaded {
  if (before === null || before.source !== scene.source || before.name !== scene.name) {
    return "new";
  }
  return before.pending > 0 && scene.pending === 0 ? "completed" : "changed";
}
