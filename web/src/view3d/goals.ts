/** Where parts belong: as boxes to reckon with, and as ghosts to be seen. */

import { Box3, Matrix4, Quaternion, Vector3 } from "three";
import type { Box } from "../model/explode";
import type { Pose } from "../model/math";
import type { Occurrence, Scene } from "../protocol/messages";
import type { GhostPart } from "./feel_layer";
import { toMatrix, type Parts } from "./parts";

/** None where there is no box. */
export function cornersOf(box: Box | undefined): Vector3[] {
  if (box === undefined) {
    return [];
  }
  const { low, high } = box;
  return Array.from({ length: 8 }, (_, k) => new Vector3(...low.map((at, axis) => ((k >> axis) & 1 ? (high[axis] ?? at) : at))));
}

/** Above the parts there is room in the picture to carry one, as a share of the radius at which parts are carried around
 the product: a choice. */
export const kHeadroom = 0.5;

/** The points, and those that are so much higher [m]. */
export function withHeadroom(points: readonly Vector3[], height: number): Vector3[] {
  return [...points, ...points.map(({ x, y, z }) => new Vector3(x, y, z + height))];
}

/** Of each part in its place, in W. */
export function goalBoxes(scene: Scene, parts: Parts): Map<number, Box> {
  const boxes = new Map<number, Box>();
  const matrix = new Matrix4();
  for (const occurrence of scene.occurrences) {
    const shape = parts.shapeOf(occurrence.id);
    if (shape !== null) {
      const box = shape.box.clone().applyMatrix4(toMatrix(occurrence.goal, matrix));
      boxes.set(occurrence.id, { low: box.min.toArray(), high: box.max.toArray() });
    }
  }
  return boxes;
}

/** Those that are not of these parts. */
export function boxesBut(boxes: ReadonlyMap<number, Box>, ids: readonly number[]): Box3[] {
  const others = [...boxes].filter(([id]) => !ids.includes(id));
  return others.map(([, { low, high }]) => new Box3(new Vector3(...low), new Vector3(...high)));
}

/** Where the weight of a part is, in W. */
export function centreOfMass(part: Occurrence | null, pose: Pose | undefined): Vector3 | null {
  if (part === null || pose === undefined) {
    return null;
  }
  const turn = new Quaternion(pose.q[1], pose.q[2], pose.q[3], pose.q[0]);
  return new Vector3(...part.p_BoBcm_m).applyQuaternion(turn).add(new Vector3(...pose.p));
}

/** The part, with what is held as one with it, in its place; and itself in its own frame. */
export function ghostsOf(occurrence: number, held: readonly number[], scene: Scene, parts: Parts): { goal: GhostPart[]; tracked: GhostPart[] } {
  const step = scene.steps.find((s) => s.occurrence === occurrence && s.kind !== "base");
  const goal = [...new Set([occurrence, ...held, ...(step?.members ?? [])])].flatMap((id) => {
    const shape = parts.shapeOf(id);
    const pose = scene.occurrences.find((o) => o.id === id)?.goal;
    return shape !== null && pose !== undefined ? [{ shape: shape.drawn, pose }] : [];
  });
  const own = parts.shapeOf(occurrence);
  return { goal, tracked: own === null ? [] : [{ shape: own, pose: { p: [0, 0, 0], q: [1, 0, 0, 0] } }] };
}

export function boxOf(points: readonly Vector3[]): Box3 {
  return new Box3().setFromPoints([...points]);
}
