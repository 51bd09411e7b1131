/** How far each part is drawn from its place when the product is shown exploded: along the way in which
 it is assembled, and beyond what goes in before it by the same way. */

import type { Step } from "../protocol/messages";
import { dot, scale, unit, type Vec3 } from "./math";

export interface Box {
  readonly low: Vec3;
  readonly high: Vec3;
}

interface Moved {
  box: Box;
  out: Vec3;
  far: number;
}

/** Spans of two boxes, seen along `direction`, overlap. */
function isInTheWay(a: Box, b: Box, direction: Vec3): boolean {
  const along = direction.map(Math.abs).reduce((best, v, k, all) => (v > (all[best] ?? 0) ? k : best), 0);
  for (let k = 0; k < 3; k++) {
    if (k !== along && ((a.low[k] ?? 0) > (b.high[k] ?? 0) || (b.low[k] ?? 0) > (a.high[k] ?? 0))) {
      return false;
    }
  }
  return true;
}

/** @param boxes  Of each occurrence in its place; those without a box stay.
 @return Offsets [m] by occurrence. */
export function explodeOffsets(steps: readonly Step[], boxes: ReadonlyMap<number, Box>): Map<number, Vec3> {
  const offsets = new Map<number, Vec3>();
  const moved: Moved[] = [];
  for (const step of steps) {
    const box = boxes.get(step.occurrence);
    if (step.kind !== "insert" || box === undefined || offsets.has(step.occurrence)) {
      continue;
    }
    const out = scale(unit(step.way_in), -1);
    const size = Math.abs(dot(out, [
      box.high[0] - box.low[0],
      box.high[1] - box.low[1],
      box.high[2] - box.low[2],
    ]));
    let far = Math.max(0.25 * step.distance_m, 0.6 * size);
    for (const other of moved) {
      if (dot(other.out, out) > 0.95 && isInTheWay(other.box, box, out)) {
        far = Math.max(far, other.far + 0.5 * size);
      }
    }
    moved.push({ box, out, far });
    for (const member of [step.occurrence, ...step.members]) {
      offsets.set(member, scale(out, far));
    }
  }
  return offsets;
}

/** The span of a box along a direction. */
function spanOf(box: Box, direction: Vec3): { low: number; high: number } {
  let low = 0;
  let high = 0;
  for (let k = 0; k < 3; k++) {
    const ends = [(box.low[k] ?? 0) * (direction[k] ?? 0), (box.high[k] ?? 0) * (direction[k] ?? 0)];
    low += Math.min(...ends);
    high += Math.max(...ends);
  }
  return { low, high };
}

/** How far from its place, against its way in, a part is beyond all of the placed ones; with some room. */
export function clearanceOf(step: Step, boxes: ReadonlyMap<number, Box>, placed: readonly number[]): number {
  const out = scale(unit(step.way_in), -1);
  const moved = [step.occurrence, ...step.members];
  const own = moved.flatMap((id) => boxes.get(id) ?? []).map((box) => spanOf(box, out));
  if (own.length === 0) {
    return step.distance_m;
  }
  const low = Math.min(...own.map((span) => span.low));
  const high = Math.max(...own.map((span) => span.high));
  const outermost = placed
    .filter((id) => !moved.includes(id))
    .flatMap((id) => boxes.get(id) ?? [])
    .reduce((most, box) => Math.max(most, spanOf(box, out).high), -Infinity);
  const room = 0.25 * (high - low) + 0.006;
  return Math.max(step.distance_m, outermost - low) + room;
}
