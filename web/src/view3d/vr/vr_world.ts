/** How the world stands around whoever is in VR: before the eyes, turned in steps, pulled by both hands. */

import { Euler, Quaternion, Vector3, type Camera, type Group } from "three";
import {
  orientation,
  placeBefore,
  pullRoom,
  scaleRoom,
  turnRoom,
  type Head,
  type Posture,
  type RoomPlacement,
  type TwoHands,
} from "../../model/room";
import { toVec3, type Vec3 } from "../../model/math";
import type { UserHand } from "./user_hand";

const kSnap = (30 * Math.PI) / 180;
/** A stick counts as pushed from here, and as let go below that. */
const kPushed = 0.7;
const kLetGo = 0.35;
const kStep = 1.25;

export class VrWorld {
  private placement: RoomPlacement = { p: [0, 0, 0], yaw: 0, scale: 1 };
  private pull: { before: RoomPlacement; from: TwoHands } | null = null;
  private readonly isTurned = [false, false];

  constructor(
    private readonly root: Group,
    private readonly eyes: Camera,
    /** In W: what is to be within reach. */
    private readonly centre: Vec3,
    private readonly radius: number,
  ) {}

  get head(): Head {
    const gaze = new Euler().setFromQuaternion(this.eyes.getWorldQuaternion(new Quaternion()), "YXZ");
    return { p: this.eyes.getWorldPosition(new Vector3()).toArray(), yaw: gaze.y };
  }

  placeBefore(posture: Posture): void {
    this.place(placeBefore(this.head, this.centre, this.radius, posture));
  }

  /** Positive: the world goes to the right, as if one had turned to the left. */
  turn(steps: number): void {
    this.place(turnRoom(this.placement, this.head.p, -steps * kSnap));
  }

  /** Larger or smaller by so many steps, about the middle of the product. */
  grow(steps: number): void {
    const middle = this.root.localToWorld(new Vector3(...this.centre)).toArray();
    this.place(scaleRoom(this.placement, middle, kStep ** steps));
  }

  /** @param hands  Those that have hold of the world itself. */
  update(all: readonly UserHand[], hands: readonly UserHand[]): void {
    for (const hand of all) {
      this.followStick(hand);
    }
    const [a, b] = hands;
    if (a === undefined || b === undefined) {
      this.pull = null;
      return;
    }
    const now: TwoHands = { a: toVec3(a.position.toArray()), b: toVec3(b.position.toArray()) };
    this.pull ??= { before: this.placement, from: now };
    this.place(pullRoom(this.pull.before, this.pull.from, now));
  }

  /** Back as the desktop has it. */
  dispose(): void {
    this.root.position.set(0, 0, 0);
    this.root.quaternion.identity();
    this.root.scale.setScalar(1);
    this.root.updateMatrixWorld(true);
  }

  private followStick(hand: UserHand): void {
    const x = hand.stickX;
    if (Math.abs(x) > kPushed && !this.isTurned[hand.index]) {
      this.turn(-Math.sign(x));
    }
    this.isTurned[hand.index] = Math.abs(x) > (this.isTurned[hand.index] ? kLetGo : kPushed);
  }

  private place(placement: RoomPlacement): void {
    this.placement = placement;
    const q = orientation(placement);
    this.root.position.set(...placement.p);
    this.root.quaternion.set(q[1], q[2], q[3], q[0]);
    this.root.scale.setScalar(placement.scale);
    this.root.updateMatrixWorld(true);
  }
}
