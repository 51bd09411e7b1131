import type { Vec3 } from "../model/math";
import type { Scene } from "../protocol/messages";

/** From where a product is seen at first: what is assembled and what lies about stand side by side. */
export function firstDirection(scene: Scene): Vec3 {
  const loose = scene.occurrences.filter((o) => o.placement === "loose").map((o) => o.start.p);
  const mean = (k: 0 | 1) => loose.reduce((sum, p) => sum + p[k] - scene.centre_m[k], 0) / Math.max(1, loose.length);
  const [x, y] = [mean(0), mean(1)];
  const far = Math.hypot(x, y);
  return far < 0.8 * scene.radius_m ? [0.62, -0.95, 0.62] : [y / far, -x / far, 0.62];
}
