/** Takes and lets go on behalf of the hands that the mouse leads, and tells the server where they are. It
 leads one at a time; the others stay where they were led to. */

import { isPointerHand } from "../model/hands";
import { toQuat, toVec3, type Pose } from "../model/math";
import { togetherWith } from "../model/store";
import type { Studio } from "../model/studio";
import type { ViewState } from "../model/view_state";
import type { LiveState } from "../protocol/frame_store";
import { kMaxHands, type HandInput } from "../protocol/frames";
import type { Command, Scene, TablePlace } from "../protocol/messages";
import { Lifetime } from "./lifetime";
import { MouseHand, type Eye } from "./mouse_hand";
import type { SceneView } from "./scene_view";

interface Taken {
  /** Of parts that were put together, the one that leads them. */
  occurrence: number;
  members: readonly number[];
  tablePlaces: readonly TablePlace[];
  X_WB: Pose;
  X_WH: Pose;
}

/** A part that is in its place is let go after this while. */
const kSettleMs = 500;

interface Led {
  readonly hand: number;
  readonly mouse: MouseHand;
  seatedSince: number | null;
}

export class HandControl {
  private readonly led: readonly Led[] = Array.from({ length: kMaxHands }, (_, hand) => ({
    hand,
    mouse: new MouseHand(hand),
    seatedSince: null,
  }));
  private isTaking = false;
  private readonly life = new Lifetime();

  constructor(
    private readonly studio: Studio,
    private readonly product: SceneView,
    private readonly view: ViewState,
  ) {
    this.life.follow(() => {
      // Whoever steers now goes on from where the part is.
      const own = studio.store.ownHands.value;
      for (const led of this.led.filter(({ hand, mouse }) => !own.includes(hand) && mouse.occurrence !== null)) {
        this.forget(led);
      }
    });
    this.life.follow(() => {
      const count = Math.max(1, studio.store.hands.value.length);
      const own = studio.store.ownHands.value.filter((hand) => hand < count);
      if (view.hand.value >= count || (own.length > 0 && !own.includes(view.hand.value))) {
        view.hand.value = own[0] ?? 0;
      }
    });
  }

  dispose(): void {
    this.life.end();
  }

  /** The hand that the mouse leads now. */
  get mouse(): MouseHand {
    return this.led[this.view.hand.peek()]!.mouse;
  }

  get isBusy(): boolean {
    return this.isTaking || this.led.some(({ mouse }) => mouse.occurrence !== null);
  }

  /** The mouse goes over to the hand that has this part, where it is one that it leads. */
  turnTo(occurrence: number): void {
    const led = this.led.find(({ mouse }) => mouse.holds(occurrence));
    if (led !== undefined) {
      this.view.hand.value = led.hand;
    }
  }

  canTake(occurrence: number): boolean {
    const { forcesOff, demo, hands, ownHands, replay } = this.studio.store;
    const part = this.product.occurrence(occurrence);
    const mayLead = isPointerHand(hands.peek(), ownHands.peek(), this.view.hand.peek()) && replay.peek() === null;
    const isFree = !this.isTaking && this.mouse.occurrence === null;
    return part !== null && !part.is_base && mayLead && isFree && !forcesOff.peek() && !demo.peek();
  }

  /** Whether the part has been in the hand since before this page steered: it was loaded anew, or
   control was handed over. */
  isLeftInHand(occurrence: number): boolean {
    const held = this.studio.store.heldBy.peek().get(occurrence);
    return held?.hand === this.view.hand.peek() && this.canTake(occurrence);
  }

  /** @param isAlone  Without what it was put together with on the table.
   @return Whether the hand holds the part now. */
  async take(occurrence: number, isAlone = false): Promise<boolean> {
    const part = this.product.occurrence(occurrence);
    const scene = this.product.scene;
    if (part === null || scene === null || !this.canTake(occurrence)) {
      return false;
    }
    const hand = this.view.hand.peek();
    this.view.explode.value = 0;
    this.view.apart.value = null;
    const taken = this.isLeftInHand(occurrence)
      ? this.takeOver(hand)
      : await this.takeUp({ command: "take", hand, occurrence, ...(isAlone ? { alone: true } : {}) }, occurrence);
    return this.lead(hand, scene, taken);
  }

  /** Takes hold of what another hand holds as well. @return Whether both hold it now. */
  async holdTogether(hand: number, other: number): Promise<boolean> {
    const held = this.studio.store.held.peek().find((each) => each.hand === other);
    const scene = this.product.scene;
    if (held === undefined || scene === null) {
      return false;
    }
    this.view.hand.value = hand;
    return this.lead(hand, scene, await this.takeUp({ command: "help", hand, other }, held.occurrence));
  }

  private lead(hand: number, scene: Scene, taken: Taken | null): boolean {
    const led = taken === null ? null : this.product.occurrence(taken.occurrence);
    if (taken === null || led === null) {
      return false;
    }
    const { mouse } = this.led[hand]!;
    const { members, tablePlaces, X_WB, X_WH } = taken;
    const own = scene.steps.find((s) => s.occurrence === led.id && s.kind === "insert") ?? null;
    const step = own === null ? null : { ...own, members };
    const radius = this.product.parts?.shapeOf(led.id)?.sphere.radius ?? 0.05;
    const clearance = step === null ? 0 : this.product.clearance(step);
    mouse.begin({ occurrence: led.id, members, tablePlaces, X_WB, goal: led.goal, step, radius, clearance }, X_WH);
    return true;
  }

  private async takeUp(command: Extract<Command, { command: "take" | "help" }>, occurrence: number): Promise<Taken | null> {
    this.isTaking = true;
    const lying = new Map(togetherWith(this.studio.store.leaders.peek(), occurrence).map((id) => [id, this.lyingAt(id)]));
    const answer = await this.studio.command(command);
    this.isTaking = false;
    if (answer === null) {
      return null;
    }
    const X_WB = lying.get(answer.occurrence) ?? this.lyingAt(answer.occurrence);
    return { occurrence: answer.occurrence, members: answer.members, tablePlaces: answer.table_places, X_WB, X_WH: answer.hand };
  }

  private lyingAt(occurrence: number): Pose {
    return this.product.poseOf(occurrence) ?? this.product.occurrence(occurrence)!.start;
  }

  private takeOver(hand: number): Taken | null {
    const state = this.studio.frames?.read()?.hands.find((h) => h.hand === hand);
    if (state === undefined) {
      return null;
    }
    const together = togetherWith(this.studio.store.leaders.peek(), state.occurrence);
    // The grip is between the hand and the part that it tracks.
    return {
      occurrence: state.occurrence,
      members: together.filter((id) => id !== state.occurrence),
      tablePlaces: [],
      X_WB: { p: toVec3(state.p_WT_m), q: toQuat(state.q_WT) },
      X_WH: { p: toVec3(state.p_WH_m), q: toQuat(state.q_WH) },
    };
  }

  /** Also what was in the hand before this page steered. */
  release(hand = this.view.hand.peek()): void {
    this.forget(this.led[hand]!);
    void this.studio.command({ command: "release", hand });
  }

  /** What is held goes into another hand, which closes on it at once. */
  passOn(hand: number, to: number): void {
    this.forget(this.led[hand]!);
    void this.studio.command({ command: "hand_over", hand, to });
  }

  /** All that is held. */
  releaseAll(): void {
    for (const { hand } of this.led.filter(({ mouse }) => mouse.occurrence !== null)) {
      this.release(hand);
    }
  }

  /** Forgets what is held without a word to the server. */
  stop(): void {
    this.led.forEach((led) => this.forget(led));
  }

  private forget(led: Led): void {
    led.mouse.end();
    led.seatedSince = null;
    if (!this.isBusy) {
      this.studio.rest();
    }
  }

  update(seconds: number, live: LiveState | null, eye: Eye): void {
    const inputs: HandInput[] = [];
    for (const led of this.led) {
      const input = this.move(led, seconds, live, eye);
      if (input !== null) {
        inputs.push(input);
      }
    }
    if (inputs.length > 0 && !document.hidden) {
      this.studio.sendInput(inputs);
    }
    for (const led of this.led) {
      this.letGoWhenSeated(led, live);
    }
  }

  private move(led: Led, seconds: number, live: LiveState | null, eye: Eye): HandInput | null {
    if (led.mouse.occurrence === null) {
      return null;
    }
    led.mouse.assists = this.view.assists.peek();
    const input = led.mouse.update(seconds, live?.hands.find((h) => h.hand === led.hand) ?? null, eye);
    if (input === null) {
      this.forget(led);
    }
    return input;
  }

  private letGoWhenSeated(led: Led, live: LiveState | null): void {
    const hand = live?.hands.find((h) => h.hand === led.hand);
    const isSeated = led.mouse.occurrence !== null && hand?.state === 5 && hand.occurrence === led.mouse.occurrence;
    if (!isSeated) {
      led.seatedSince = null;
      return;
    }
    led.seatedSince ??= performance.now();
    const hasSettled = performance.now() - led.seatedSince > kSettleMs;
    if (hasSettled && this.view.letsGoWhenSeated.peek()) {
      this.release(led.hand);
    }
  }
}
