import type { Vec3 } from "../model/math";
import type { Scene } from "../protocol/messages";

/** From where a product is seen at first: it stands in front, and its parts lie behind it. */
export function firstDirection(scene: Scene): Vec3 {
  return scene.occurrences.some((o) => o.placement === "loose") ? [0.34, -1, 1] : [0.62, -0.95, 0.62];
}
