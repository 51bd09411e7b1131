/** Takes and lets go on behalf of the mouse hand, and tells the server where it is. */

import { effect } from "@preact/signals";
import { toQuat, toVec3, type Pose } from "../model/math";
import type { Studio } from "../model/studio";
import type { ViewState } from "../model/view_state";
import type { LiveState } from "../protocol/frame_store";
import type { Occurrence } from "../protocol/messages";
import { MouseHand, type Eye } from "./mouse_hand";
import type { SceneView } from "./scene_view";

interface Taken {
  X_WB: Pose;
  X_WH: Pose;
}

const kHand = 0;
/** A part that is in its place is let go after this while. */
const kSettleMs = 500;

export class HandControl {
  readonly mouse = new MouseHand();
  private isTaking = false;
  private seatedSince: number | null = null;

  constructor(
    private readonly studio: Studio,
    private readonly product: SceneView,
    private readonly view: ViewState,
  ) {
    effect(() => {
      // Whoever steers now goes on from where the part is.
      if (!studio.store.hasLease.value && this.mouse.occurrence !== null) {
        this.stop();
      }
    });
  }

  get isBusy(): boolean {
    return this.isTaking || this.mouse.occurrence !== null;
  }

  canTake(occurrence: number): boolean {
    const { hasLease, forcesOff, demo } = this.studio.store;
    const part = this.product.occurrence(occurrence);
    return part !== null && !part.is_base && hasLease.peek() && !forcesOff.peek() && !demo.peek() && !this.isBusy;
  }

  /** Whether the part has been in the hand since before this page steered: it was loaded anew, or
   control was handed over. */
  isLeftInHand(occurrence: number): boolean {
    const held = this.studio.store.heldBy.peek().get(occurrence);
    return held?.hand === kHand && this.canTake(occurrence);
  }

  /** @return Whether the hand holds the part now. */
  async take(occurrence: number): Promise<boolean> {
    const part = this.product.occurrence(occurrence);
    const scene = this.product.scene;
    if (part === null || scene === null || !this.canTake(occurrence)) {
      return false;
    }
    this.view.explode.value = 0;
    const taken = this.isLeftInHand(occurrence) ? this.takeOver() : await this.takeUp(part);
    if (taken === null) {
      return false;
    }
    const step = scene.steps.find((s) => s.occurrence === occurrence && s.kind === "insert") ?? null;
    const radius = this.product.parts?.shapeOf(occurrence)?.sphere.radius ?? 0.05;
    const clearance = step === null ? 0 : this.product.clearance(step);
    this.mouse.begin({ occurrence, X_WB: taken.X_WB, goal: part.goal, step, radius, clearance }, taken.X_WH);
    return true;
  }

  private async takeUp(part: Occurrence): Promise<Taken | null> {
    this.isTaking = true;
    const X_WB = this.product.poseOf(part.id) ?? part.start;
    const answer = await this.studio.command({ command: "take", hand: kHand, occurrence: part.id });
    this.isTaking = false;
    return answer === null ? null : { X_WB, X_WH: answer.hand };
  }

  private takeOver(): Taken | null {
    const hand = this.studio.frames?.read()?.hands.find((h) => h.hand === kHand);
    if (hand === undefined) {
      return null;
    }
    // The grip is between the hand and the part that it tracks.
    return {
      X_WB: { p: toVec3(hand.p_WT_m), q: toQuat(hand.q_WT) },
      X_WH: { p: toVec3(hand.p_WH_m), q: toQuat(hand.q_WH) },
    };
  }

  /** Also what was in the hand before this page steered. */
  release(): void {
    this.stop();
    void this.studio.command({ command: "release", hand: kHand });
  }

  /** Forgets what is held without a word to the server. */
  stop(): void {
    this.mouse.end();
    this.seatedSince = null;
    this.studio.rest();
  }

  update(seconds: number, live: LiveState | null, eye: Eye): void {
    if (this.mouse.occurrence === null) {
      return;
    }
    this.mouse.assists = this.view.assists.peek();
    const hand = live?.hands.find((h) => h.hand === kHand) ?? null;
    const input = this.mouse.update(seconds, hand, eye);
    if (input === null) {
      this.stop();
      return;
    }
    if (!document.hidden) {
      this.studio.sendInput([input]);
    }
    const isSeated = hand?.state === 5 && hand.occurrence === this.mouse.occurrence;
    this.letGoWhenSeated(isSeated);
  }

  private letGoWhenSeated(isSeated: boolean): void {
    if (!isSeated) {
      this.seatedSince = null;
      return;
    }
    this.seatedSince ??= performance.now();
    const hasSettled = performance.now() - this.seatedSince > kSettleMs;
    if (hasSettled && this.view.letsGoWhenSeated.peek()) {
      this.release();
    }
  }
}
