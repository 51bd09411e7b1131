/** How a part that gives changes its form: the mapping of points of docs/algorithms/flexible.md, "Drawn deformed". */

import type { Deformable, Vec3 } from "../protocol/messages";

/** Points so far beyond the box of an arm belong to it [m]: a choice, as in simulation/deformation.cc. */
const kArmSlack = 20e-6;
/** A ring narrows to no less than this share of its radius: a choice. */
const kLeastRadius = 0.5;

function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function add(a: Vec3, factor: number, b: Vec3): Vec3 {
  return [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
}

/** Deflection of a cantilever at x from its root, by y at l. */
function beam(x: number, l: number, y: number): number {
  if (x <= 0) {
    return 0;
  }
  return x >= l ? (y * (3 * x - l)) / (2 * l) : (y * x * x * (3 * l - x)) / (2 * l * l * l);
}

function isWithin(value: number, [low, high]: readonly [number, number]): boolean {
  return value >= low - kArmSlack && value <= high + kArmSlack;
}

function clamp01(value: number): number {
  return Math.min(1, Math.max(0, value));
}

/** Where a point of the part's frame goes, by an amount [m]. */
export function deformPoint(form: Deformable, amount: number, p: Vec3): Vec3 {
  if (amount === 0) {
    return p;
  }
  const { axis, aside, length_m: length, shares } = form;
  const d = add(p, -1, form.origin_m);
  const along = dot(d, axis);
  const side = cross(axis, aside);
  if (form.kind === "shift") {
    return add(p, amount, axis);
  }
  if (form.kind === "press") {
    return add(p, amount * clamp01(along / length), axis);
  }
  if (form.kind === "bend") {
    const isArm = along > 0 && isWithin(dot(d, aside), form.range_m) && isWithin(dot(d, side), form.across_m);
    return isArm ? add(p, beam(along, length, amount), aside) : p;
  }
  const radial = add(d, -along, axis);
  const radius = Math.hypot(...radial);
  const outward: Vec3 = radius > 0 ? [radial[0] / radius, radial[1] / radius, radial[2] / radius] : [0, 0, 0];
  const [inner, outer] = form.range_m;
  const share = shares[0] + (outer > inner ? clamp01((radius - inner) / (outer - inner)) : 0) * (shares[1] - shares[0]);
  const angle = Math.atan2(dot(outward, side), dot(outward, aside));
  switch (form.kind) {
    case "flare":
      return along > 0 && isWithin(radius, form.range_m) ? add(p, shares[0] * beam(along, length, amount), outward) : p;
    case "radial":
      return add(p, Math.max(share * amount, -radius), outward);
    case "cone":
      return add(p, share * amount, axis);
    case "helix":
      return add(p, amount * (0.5 + (shares[0] * angle) / (2 * Math.PI)), axis);
    default: {
      const y = Math.max(amount, -kLeastRadius * length);
      const turned = (angle * length) / (length + y);
      const back = add(add(form.origin_m, along, axis), (radius + y) * Math.cos(turned), aside);
      return add(back, (radius + y) * Math.sin(turned), side);
    }
  }
}
