/**
 * What turns the two axes of a mouse into the six of a hand, and makes a shaft find its bore.
 *
 * All poses are of the hand H in W. The goal is where the hand would be with the part in its place.
 */

import {
  add,
  distance,
  dot,
  lerp,
  nearestOnLine,
  norm,
  scale,
  slerp,
  sub,
  unit,
  type Pose,
  type Vec3,
} from "./math";

export interface Ray {
  from: Vec3;
  /** Unit. */
  along: Vec3;
}

export interface Line {
  p: Vec3;
  /** Unit. */
  d: Vec3;
  /** Distances from p along d between which the hand may be put. */
  low: number;
  high: number;
}

/** Where a ray meets the plane through `p` with normal `n`; null when it hardly does. */
export function rayOnPlane(ray: Ray, p: Vec3, n: Vec3): Vec3 | null {
  const slope = dot(ray.along, n);
  if (Math.abs(slope) < 1e-4) {
    return null;
  }
  const t = dot(sub(p, ray.from), n) / slope;
  return t > 0 ? add(ray.from, scale(ray.along, t)) : null;
}

/** The hand may go so far beyond the part's place [m]: a press fit gives way only to a hand that leads. */
const kPressing = 0.03;

/** The way in as a line for the hand: from its place outwards. */
export function wayInLine(goal: Pose, wayIn: Vec3, length: number): Line {
  return { p: goal.p, d: scale(unit(wayIn), -1), low: -kPressing, high: length };
}

export interface Snap {
  p: Vec3;
  /** How far the ray passes from the line there [m]. */
  off: number;
  /** From the eye [m]. */
  depth: number;
}

/** The point of the line that the ray points at. */
export function pointAtLine(ray: Ray, line: Line): Snap {
  const s = Math.min(line.high, Math.max(line.low, nearestOnLine(line.p, line.d, ray.from, ray.along)));
  const p = add(line.p, scale(line.d, s));
  const depth = Math.max(1e-6, dot(sub(p, ray.from), ray.along));
  return { p, off: distance(p, add(ray.from, scale(ray.along, depth))), depth };
}

/** Moves `from` towards `to`: a share that would halve the way in `halfLife`, at `fastest` at most. */
export function ease(from: Vec3, to: Vec3, seconds: number, halfLife: number, fastest: number): Vec3 {
  const share = 1 - Math.pow(0.5, seconds / halfLife);
  const step = scale(sub(to, from), share);
  const length = norm(step);
  const longest = fastest * seconds;
  return length > longest ? add(from, scale(step, longest / length)) : add(from, step);
}

export function easeTurn(from: Pose["q"], to: Pose["q"], seconds: number, halfLife: number): Pose["q"] {
  return slerp(from, to, 1 - Math.pow(0.5, seconds / halfLife));
}

/** No further from `from` than `longest`: the coupling pulls with all of that distance. */
export function leash(from: Vec3, to: Vec3, longest: number): Vec3 {
  const d = distance(from, to);
  return d > longest ? lerp(from, to, longest / d) : to;
}

/** How far a point is from the line [m]. */
export function offLine(p: Vec3, line: Line): number {
  const r = sub(p, line.p);
  return norm(sub(r, scale(line.d, dot(r, line.d))));
}

/** How far off the way in the hand may be to go along it: a share of its length, and as much at least [m]; choices. */
const kInLineShare = 0.03;
const kInLineLeast = 5e-4;

export function inLineWithin(line: Line): number {
  return kInLineShare * line.high + kInLineLeast;
}

/** From this share of the way in outwards the hand may cross over to it. */
const kOutside = 0.96;

/** To where the way in begins: out beside it and across, never through what stands around it. */
export function approach(from: Vec3, line: Line): Vec3 {
  const s = dot(sub(from, line.p), line.d);
  const outer = add(line.p, scale(line.d, line.high));
  if (s > kOutside * line.high) {
    return outer;
  }
  const beside = sub(from, add(line.p, scale(line.d, s)));
  return add(outer, beside);
}
