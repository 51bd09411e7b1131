/** The eye that moves by itself: to the next part and its place where they are not well seen, and once around the
 product when all its parts are in. */

import { untracked } from "@preact/signals";
import type { Vector3 } from "three";
import type { Studio } from "../model/studio";
import type { ViewState } from "../model/view_state";
import type { Vec3 } from "../protocol/messages";
import type { CameraRig } from "./camera_rig";
import { boxOf } from "./goals";
import { Lifetime } from "./lifetime";
import type { SceneView } from "./scene_view";

/** A part or place that is smaller in the picture is hard to press on [px]: as a target of WCAG 2.5.8 is large. */
const kLeastSeen = 24;
/** Once around the finished product [s]: a choice. */
const kRoundS = 6;

/** A product that is larger than the next part by more than this is not shown as a whole beside it: a choice, by which
 the part is still an eighth of the height of the picture. */
const kMostTimesLarger = 8;

/** The length of the diagonal of the box around points [m]. */
function reachOf(points: readonly Vector3[]): number {
  const box = boxOf(points);
  return box.isEmpty() ? 0 : box.min.distanceTo(box.max);
}

/** The picture that is guided. */
interface GuidedView {
  readonly rig: CameraRig;
  readonly product: SceneView;
  readonly hand: { readonly isBusy: boolean };
  readonly canvas: HTMLCanvasElement;
  project(p: Vec3): { x: number; y: number; isBehind: boolean };
  invalidate(): void;
}

export class CameraGuide {
  private readonly life = new Lifetime();
  private roundLeft = 0;
  private wasDone = true;

  constructor(
    private readonly viewport: GuidedView,
    private readonly studio: Studio,
    private readonly view: ViewState,
  ) {
    this.life.follow(() => {
      void studio.store.expected.value;
      untracked(() => this.showNext());
    });
    this.life.follow(() => {
      const isDone = studio.store.scene.value !== null && studio.store.isDone.value;
      untracked(() => this.onDone(isDone));
    });
    // Whoever presses on the picture leads the eye.
    this.life.listen(viewport.canvas, "pointerdown", () => (this.roundLeft = 0), { capture: true });
  }

  dispose(): void {
    this.life.end();
  }

  /** Brings the next part and its place into the picture.
   @param isSure  Also where both are seen well already. */
  showNext(isSure = false): void {
    const { product, hand, rig } = this.viewport;
    const step = this.studio.store.expected.peek();
    const place = step === null ? [] : product.placeOf(step.occurrence);
    if (step === null || place.length === 0 || !this.isWanted || hand.isBusy || this.view.explode.peek() > 0 || this.view.apart.peek() !== null) {
      return;
    }
    const part = product.outline([step.occurrence]);
    if (isSure || !this.isSeen(part) || !this.isSeen(place)) {
      // What is there already says where the place is, unless the part were too small beside it.
      const there = product.outline(this.listPlaced());
      const isSmall = reachOf(part) * kMostTimesLarger < reachOf(there);
      rig.fit([...part, ...place, ...(isSmall ? [] : there)]);
      this.viewport.invalidate();
    }
  }

  /** Goes on around the product. */
  tick(seconds: number): void {
    if (this.roundLeft > 0) {
      this.roundLeft -= seconds;
      this.viewport.rig.turn((2 * Math.PI * seconds) / kRoundS, 0);
      this.viewport.invalidate();
    }
  }

  /** Neither in a study nor in a recording, whose eye is the user's own. */
  private get isWanted(): boolean {
    const { study, replay, followed } = this.studio.store;
    return this.view.followsSteps.peek() && study.peek() === null && replay.peek() === null && followed.peek() === null;
  }

  private listPlaced(): number[] {
    const { placements, scene } = this.studio.store;
    const all = scene.peek()?.occurrences ?? [];
    return all.filter(({ id, is_base: isBase }) => isBase || placements.peek().get(id) === "placed").map(({ id }) => id);
  }

  private onDone(isDone: boolean): void {
    const isFinished = isDone && !this.wasDone;
    this.wasDone = isDone;
    this.roundLeft = 0;
    if (isFinished && this.isWanted) {
      this.viewport.rig.view("iso", this.viewport.product.outline());
      this.roundLeft = this.view.isCalm.peek() ? 0 : kRoundS;
      this.viewport.invalidate();
    }
  }

  /** Whether a box lies in the part of the picture that no panel covers, and is not too small in it. */
  private isSeen(corners: readonly Vector3[]): boolean {
    const { clientWidth, clientHeight } = this.viewport.canvas;
    const { left, right, top, bottom } = this.viewport.rig.rim();
    const isFree = (x: number, y: number) =>
      x >= left * clientWidth && x <= (1 - right) * clientWidth && y >= top * clientHeight && y <= (1 - bottom) * clientHeight;
    const at = corners.map((corner) => this.viewport.project(corner.toArray()));
    const [xs, ys] = [at.map(({ x }) => x), at.map(({ y }) => y)];
    const isInside = at.every(({ x, y, isBehind }) => !isBehind && isFree(x, y));
    const reach = Math.hypot(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
    return isInside && reach >= kLeastSeen;
  }
}
