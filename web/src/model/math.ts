/** Vectors, quaternions (w, x, y, z) and poses as plain tuples; SI; frames as in docs/conventions.md. */

import type { Pose, Quat, Vec3 } from "../protocol/messages";

export type { Pose, Quat, Vec3 };

export const kZero: Vec3 = [0, 0, 0];
export const kNoTurn: Quat = [1, 0, 0, 0];

export function toVec3(v: ArrayLike<number>, at = 0): Vec3 {
  return [v[at] ?? 0, v[at + 1] ?? 0, v[at + 2] ?? 0];
}

export function toQuat(v: ArrayLike<number>, at = 0): Quat {
  return [v[at] ?? 1, v[at + 1] ?? 0, v[at + 2] ?? 0, v[at + 3] ?? 0];
}

export function add(a: Vec3, b: Vec3): Vec3 {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

export function sub(a: Vec3, b: Vec3): Vec3 {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

export function scale(a: Vec3, s: number): Vec3 {
  return [a[0] * s, a[1] * s, a[2] * s];
}

export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function norm(a: Vec3): number {
  return Math.sqrt(dot(a, a));
}

export function distance(a: Vec3, b: Vec3): number {
  return norm(sub(a, b));
}

/** The unit vector along `a`, or `fallback` where `a` has no direction. */
export function unit(a: Vec3, fallback: Vec3 = [0, 0, 1]): Vec3 {
  const n = norm(a);
  return n > 1e-12 ? scale(a, 1 / n) : fallback;
}

export function lerp(a: Vec3, b: Vec3, t: number): Vec3 {
  return add(a, scale(sub(b, a), t));
}

export function multiply(a: Quat, b: Quat): Quat {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}

export function conjugate(q: Quat): Quat {
  return [q[0], -q[1], -q[2], -q[3]];
}

export function normalized(q: Quat): Quat {
  const n = Math.hypot(...q);
  return n > 1e-12 ? [q[0] / n, q[1] / n, q[2] / n, q[3] / n] : kNoTurn;
}

export function rotate(q: Quat, v: Vec3): Vec3 {
  const u: Vec3 = [q[1], q[2], q[3]];
  const t = scale(cross(u, v), 2);
  return add(add(v, scale(t, q[0])), cross(u, t));
}

export function turnAbout(axis: Vec3, angle: number): Quat {
  const [x, y, z] = scale(unit(axis), Math.sin(angle / 2));
  return [Math.cos(angle / 2), x, y, z];
}

/** Angle between two orientations [rad]. */
export function angleBetween(a: Quat, b: Quat): number {
  const d = Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
  return 2 * Math.acos(Math.min(1, d));
}

/** The shortest turn from `a` to `b`, `t` of the way. */
export function slerp(a: Quat, b: Quat, t: number): Quat {
  let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = cosine < 0 ? -1 : 1;
  cosine *= sign;
  let wa = 1 - t;
  let wb = t;
  if (cosine < 0.9999) {
    const angle = Math.acos(cosine);
    wa = Math.sin((1 - t) * angle) / Math.sin(angle);
    wb = Math.sin(t * angle) / Math.sin(angle);
  }
  wb *= sign;
  return normalized([
    a[0] * wa + b[0] * wb,
    a[1] * wa + b[1] * wb,
    a[2] * wa + b[2] * wb,
    a[3] * wa + b[3] * wb,
  ]);
}

export function compose(a: Pose, b: Pose): Pose {
  return { p: add(a.p, rotate(a.q, b.p)), q: normalized(multiply(a.q, b.q)) };
}

export function inverse(a: Pose): Pose {
  const q = conjugate(a.q);
  return { p: scale(rotate(q, a.p), -1), q };
}

/** The point of the line (p, unit direction d) that is nearest to a ray, as a distance from p along d. */
export function nearestOnLine(p: Vec3, d: Vec3, rayFrom: Vec3, rayAlong: Vec3): number {
  const r = sub(p, rayFrom);
  const b = dot(d, rayAlong);
  const denominator = 1 - b * b;
  if (denominator < 1e-4) {
    return 0;
  }
  return (b * dot(rayAlong, r) - dot(d, r)) / denominator;
}
