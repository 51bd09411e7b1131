/** Takes parts with the hands of somebody in VR, leads them, and lets the controllers tell what they feel. */

import { Vector3, type Group } from "three";
import { handOfUser } from "../../model/hands";
import { compose, inverse, toQuat, toVec3, type Pose } from "../../model/math";
import type { HeldSummary } from "../../model/store";
import type { Studio } from "../../model/studio";
import { kGrabPulse, kRefusedPulse, Vibration } from "../../model/vibration";
import type { HandInput } from "../../protocol/frames";
import type { Viewport } from "../viewport";
import type { UserHand } from "./user_hand";

/** Parts nearer than this to the hand can be taken, in metres of the room. */
const kReach = 0.1;
const kLookMs = 80;

interface Hold {
  occurrence: number;
  /** The server's hand. */
  hand: number;
  /** The server's hand in the frame of the user's, C. */
  X_CH: Pose;
  sent: Pose;
  wasTracked: boolean;
}

/** What the server's hand has been given. */
interface TakenInRoom {
  hand: number;
  /** Of parts that were put together, the one that leads them. */
  occurrence: number;
  X_WH: Pose;
}

export class VrHands {
  private readonly holds = new Map<UserHand, Hold>();
  private readonly asking = new Set<UserHand>();
  private readonly vibrations = new Map<UserHand, Vibration>();
  private lastLook = 0;

  constructor(
    private readonly port: Viewport,
    private readonly studio: Studio,
    private readonly world: Group,
    private readonly hands: readonly UserHand[],
  ) {}

  isHolding(hand: UserHand): boolean {
    return this.holds.has(hand) || this.asking.has(hand);
  }

  /** The part within reach, if any. */
  nearest(hand: UserHand): number | null {
    const { product } = this.port;
    const at = hand.position;
    const centre = new Vector3();
    let best: number | null = null;
    let least = kReach;
    for (const entry of product.parts?.entries ?? []) {
      const part = product.occurrence(entry.occurrence);
      if (part === null || part.is_base || entry.look.isHidden) {
        continue;
      }
      centre.copy(entry.shape.sphere.center).applyMatrix4(entry.matrix).applyMatrix4(this.world.matrixWorld);
      const gap = centre.distanceTo(at) - 0.5 * entry.shape.sphere.radius * this.world.scale.x;
      if (gap < least) {
        least = gap;
        best = entry.occurrence;
      }
    }
    return best;
  }

  /** @return Whether there is something to take hold of. */
  grab(hand: UserHand): boolean {
    const hold = this.holds.get(hand);
    if (hold !== undefined) {
      this.takeGripAnew(hand, hold);
      return true;
    }
    const occurrence = this.nearest(hand);
    if (occurrence === null) {
      return false;
    }
    void this.take(hand, occurrence);
    return true;
  }

  release(hand: UserHand): void {
    this.asking.delete(hand);
    const hold = this.holds.get(hand);
    if (hold !== undefined) {
      this.holds.delete(hand);
      if (this.holds.size === 0) {
        this.studio.rest();
      }
      void this.studio.command({ command: "release", hand: hold.hand });
    }
  }

  releaseAll(): void {
    this.hands.forEach((hand) => this.release(hand));
  }

  update(now: number): void {
    this.dropWhatIsGone();
    const inputs = [...this.holds].flatMap(([hand, hold]) => this.lead(hand, hold) ?? []);
    if (inputs.length > 0) {
      this.studio.sendInput(inputs);
    }
    for (const [hand, hold] of this.holds) {
      this.vibrate(hand, hold, now);
    }
    this.markNearest(now);
  }

  private async take(hand: UserHand, occurrence: number): Promise<void> {
    if (this.isHolding(hand)) {
      return;
    }
    const free = this.freeHand(hand);
    const left = this.studio.store.heldBy.peek().get(occurrence);
    if (free === null && left === undefined) {
      hand.pulse(kRefusedPulse);
      return;
    }
    this.asking.add(hand);
    const taken = left !== undefined ? this.takeOver(left) : await this.takeUp(free ?? 0, occurrence);
    if (taken === null) {
      this.asking.delete(hand);
      hand.pulse(kRefusedPulse);
      return;
    }
    this.holds.set(hand, {
      occurrence: taken.occurrence,
      hand: taken.hand,
      X_CH: compose(inverse(hand.poseIn(this.world)), taken.X_WH),
      sent: taken.X_WH,
      wasTracked: true,
    });
    hand.pulse(kGrabPulse);
    if (!this.asking.delete(hand)) {
      // It was let go while the server answered.
      this.release(hand);
    }
  }

  private async takeUp(hand: number, occurrence: number): Promise<TakenInRoom | null> {
    const answer = await this.studio.command({ command: "take", hand, occurrence });
    return answer === null ? null : { hand, occurrence: answer.occurrence, X_WH: answer.hand };
  }

  /** What has been in the hand since before, or changes from one of the user's hands to the other. */
  private takeOver({ hand, occurrence }: HeldSummary): TakenInRoom | null {
    const live = this.port.live?.hands.find((h) => h.hand === hand);
    for (const [other, hold] of this.holds) {
      if (hold.hand === hand) {
        this.holds.delete(other);
      }
    }
    return live === undefined ? null : { hand, occurrence, X_WH: { p: toVec3(live.p_WH_m), q: toQuat(live.q_WH) } };
  }

  /** The server's hand for one of the user's. */
  private freeHand(hand: UserHand): number | null {
    const busy = new Set(this.studio.store.held.peek().map((h) => h.hand));
    const isLeft = hand.handedness === "left" || (hand.handedness !== "right" && hand.index === 1);
    const wished = handOfUser(this.studio.store.ownHands.peek(), isLeft);
    return wished === null || busy.has(wished) ? null : wished;
  }

  private lead(hand: UserHand, hold: Hold): HandInput | null {
    if (!hand.isTracked) {
      // Nothing is said of a hand that is out of sight: the part stays where it is.
      hold.wasTracked = false;
      return null;
    }
    if (!hold.wasTracked) {
      this.takeGripAnew(hand, hold);
    }
    hold.sent = compose(hand.poseIn(this.world), hold.X_CH);
    return {
      hand: hold.hand,
      buttons: 1,
      p_WH_m: hold.sent.p,
      q_WH: hold.sent.q,
      client_ms: performance.now() % 1e6,
    };
  }

  /** So that the part does not leap to where the hand has got meanwhile. */
  private takeGripAnew(hand: UserHand, hold: Hold): void {
    hold.X_CH = compose(inverse(hand.poseIn(this.world)), hold.sent);
    hold.wasTracked = true;
  }

  /** Somebody else let go of it, or the scene has changed. */
  private dropWhatIsGone(): void {
    const held = this.studio.store.held.peek();
    for (const [hand, hold] of this.holds) {
      const live = this.port.live?.hands.find((h) => h.hand === hold.hand);
      const isKnown = held.some((h) => h.hand === hold.hand && h.occurrence === hold.occurrence);
      if (live !== undefined && live.state === 0 && !isKnown && this.wasSeen.has(hold)) {
        this.holds.delete(hand);
      } else if (isKnown) {
        this.wasSeen.add(hold);
      }
    }
  }

  private readonly wasSeen = new WeakSet<Hold>();

  private vibrate(hand: UserHand, hold: Hold, now: number): void {
    const live = this.port.live?.hands.find((h) => h.hand === hold.hand);
    const vibration = this.vibrations.get(hand) ?? new Vibration();
    this.vibrations.set(hand, vibration);
    const pulse = live === undefined || !hand.isTracked ? null : vibration.next(live, now);
    if (pulse !== null) {
      hand.pulse(pulse);
    }
  }

  /** The part that a grab would take is marked, as under a mouse. */
  private markNearest(now: number): void {
    if (now - this.lastLook < kLookMs) {
      return;
    }
    this.lastLook = now;
    const idle = this.hands.filter((hand) => hand.isTracked && !this.isHolding(hand));
    this.port.view.hovered.value = idle.map((hand) => this.nearest(hand)).find((id) => id !== null) ?? null;
  }
}
