/**
 * How the world W stands in the room R of somebody in VR: Y up, the floor at 0, metres of the room.
 *
 * X_RW turns W upright (its z is the room's y), then about the vertical by `yaw`, and scales.
 */

import { add, distance, multiply, rotate, scale, sub, turnAbout, type Quat, type Vec3 } from "./math";

export interface RoomPlacement {
  p: Vec3;
  yaw: number;
  scale: number;
}

export interface Head {
  p: Vec3;
  /** Of the line of sight about the vertical; 0 looks along -z. */
  yaw: number;
}

export type Posture = "seated" | "standing";

const kUp: Vec3 = [0, 1, 0];
/** W's z upwards. */
const kUpright: Quat = turnAbout([1, 0, 0], -Math.PI / 2);
/** Of what is within reach of the arms [m]. */
const kReach: Record<Posture, { radius: number; ahead: number; below: number }> = {
  seated: { radius: 0.34, ahead: 0.46, below: 0.36 },
  standing: { radius: 0.45, ahead: 0.6, below: 0.48 },
};
/** The middle of the product is no lower than this above the floor [m]. */
const kLowest = 0.55;
/** A product is shown no larger, and no smaller, than so many times its size. */
export const kScales = { least: 0.02, most: 20, first: 3 };

export function orientation(placement: RoomPlacement): Quat {
  return multiply(turnAbout(kUp, placement.yaw), kUpright);
}

export function toRoom(placement: RoomPlacement, p_W: Vec3): Vec3 {
  return add(placement.p, scale(rotate(orientation(placement), p_W), placement.scale));
}

/** So that `centre` of W comes to stand at `p` of the room. */
function standAt(p: Vec3, centre: Vec3, yaw: number, factor: number): RoomPlacement {
  const turned = { p: [0, 0, 0] as Vec3, yaw, scale: factor };
  return { ...turned, p: sub(p, toRoom(turned, centre)) };
}

/** A sphere of W before the eyes, within arms' reach. */
export function placeBefore(head: Head, centre: Vec3, radius: number, posture: Posture): RoomPlacement {
  const reach = kReach[posture];
  const factor = clampScale(Math.min(kScales.first, reach.radius / Math.max(radius, 1e-6)));
  const ahead: Vec3 = [-Math.sin(head.yaw), 0, -Math.cos(head.yaw)];
  const at = add(head.p, scale(ahead, reach.ahead + 0.25 * radius * factor));
  const height = Math.max(kLowest, head.p[1] - reach.below);
  return standAt([at[0], height, at[2]], centre, head.yaw, factor);
}

/** Turned about the vertical through a point of the room, as if whoever stands there had turned. */
export function turnRoom(placement: RoomPlacement, about: Vec3, angle: number): RoomPlacement {
  const from = sub(placement.p, about);
  return { ...placement, p: add(about, rotate(turnAbout(kUp, angle), from)), yaw: placement.yaw + angle };
}

/** Larger or smaller about a point of the room. */
export function scaleRoom(placement: RoomPlacement, about: Vec3, factor: number): RoomPlacement {
  const wanted = clampScale(placement.scale * factor);
  const share = wanted / placement.scale;
  return { ...placement, p: add(about, scale(sub(placement.p, about), share)), scale: wanted };
}

export interface TwoHands {
  a: Vec3;
  b: Vec3;
}

/** Both hands have hold of the world: what was in them then is in them now, upright. */
export function pullRoom(before: RoomPlacement, from: TwoHands, to: TwoHands): RoomPlacement {
  const middle = (hands: TwoHands) => scale(add(hands.a, hands.b), 0.5);
  const bearing = ({ a, b }: TwoHands) => Math.atan2(-(b[2] - a[2]), b[0] - a[0]);
  const grown = scaleRoom(before, middle(from), distance(to.a, to.b) / Math.max(0.02, distance(from.a, from.b)));
  const turned = turnRoom(grown, middle(from), bearing(to) - bearing(from));
  return { ...turned, p: add(turned.p, sub(middle(to), middle(from))) };
}

function clampScale(wanted: number): number {
  return Math.min(kScales.most, Math.max(kScales.least, wanted));
}
