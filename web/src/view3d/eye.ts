/** Where one looks from, as the hand of the mouse needs it. */

import { Vector2, Vector3, type Raycaster } from "three";
import type { Vec3 } from "../model/math";
import type { CameraRig } from "./camera_rig";
import type { Eye } from "./mouse_hand";

/** @param height  Of the picture [px]. */
export function makeEye(rig: CameraRig, caster: Raycaster, height: number): Eye {
  const { camera } = rig;
  camera.updateMatrixWorld();
  const axis = (column: number): Vec3 => new Vector3().setFromMatrixColumn(camera.matrixWorld, column).toArray();
  const from = camera.position;
  return {
    right: axis(0),
    up: axis(1),
    back: axis(2),
    rayTo: (p) => {
      const { x, y } = new Vector3(...p).project(camera);
      caster.setFromCamera(new Vector2(x, y), camera);
      return { from: caster.ray.origin.toArray(), along: caster.ray.direction.toArray() };
    },
    metresPerPixel: (p) => rig.metresPerPixel(new Vector3(...p).distanceTo(from), height),
  };
}
