/** Mouse, pen and fingers on the view: hover, select, pick faces, take and lead a part. */

import type { Ray as ThreeRay } from "three";
import type { Ray } from "../model/assist";
import type { Studio } from "../model/studio";
import type { ViewState } from "../model/view_state";
import type { Vec3 } from "../protocol/messages";
import type { CameraRig } from "./camera_rig";
import { Clicks } from "./clicks";
import { Fingers, type Point } from "./fingers";
import type { HandControl } from "./hand_control";
import { Lifetime } from "./lifetime";
import type { Eye } from "./mouse_hand";
import type { PickHit } from "./parts";
import type { SceneView } from "./scene_view";
import type { WorkshopHost } from "./workshop_host";

/** A press that moves further than this is a drag [px]. */
const kClickPx = 4;
const kTurnPerPx = 0.008;
const kHoverMs = 40;
/** Of what stands on the bench, a notch of the wheel [rad]. */
const kBenchTurn = Math.PI / 12;

type Gesture =
  | { kind: "none" }
  /** May become a click, or a drag of the part. */
  | { kind: "press"; x: number; y: number; hit: PickHit | null; takes: boolean }
  | { kind: "taking"; x: number; y: number }
  | { kind: "drag" }
  /** Two fingers: the part turns as they do, and goes away from the eye as they close. */
  | { kind: "pinch" }
  | { kind: "turn"; x: number; y: number }
  /** Of something on the bench. */
  | { kind: "bench" };

function plain(ray: ThreeRay): Ray {
  return { from: ray.origin.toArray(), along: ray.direction.toArray() };
}

/** The picture that is pointed at. */
export interface PointedView {
  readonly canvas: HTMLCanvasElement;
  readonly view: ViewState;
  readonly rig: CameraRig;
  readonly eye: Eye;
  readonly product: SceneView;
  readonly hand: HandControl;
  readonly workshop: WorkshopHost;
  /** Through a point of the canvas [px]. */
  rayAt(x: number, y: number): ThreeRay;
  /** Direction that the side of the cube at this point looks along; null beside it. */
  pickCube(x: number, y: number): Vec3 | null;
  /** Brings these parts into the picture, or all. */
  fit(only?: readonly number[]): void;
}

export class PointerInput {
  onContextMenu: (x: number, y: number, hit: PickHit | null) => void = () => {};
  private gesture: Gesture = { kind: "none" };
  private at: Point = { x: 0, y: 0 };
  private readonly fingers = new Fingers();
  private readonly clicks: Clicks;
  private rightPress: Point | null = null;
  private lastHover = 0;
  private readonly life = new Lifetime();

  constructor(
    private readonly viewport: PointedView,
    private readonly studio: Studio,
  ) {
    this.clicks = new Clicks(viewport, studio);
    const { life } = this;
    const { canvas } = viewport;
    // Captured, so that the eye's controls can be stopped before they hear of it.
    life.listen<PointerEvent>(canvas, "pointerdown", (e) => this.onDown(e), { capture: true });
    life.listen<PointerEvent>(canvas, "pointermove", (e) => this.onMove(e));
    life.listen<PointerEvent>(canvas, "pointerup", (e) => this.onUp(e));
    life.listen<PointerEvent>(canvas, "pointercancel", (e) => {
      this.fingers.lift(e);
      this.finish();
    });
    life.listen(canvas, "pointerleave", () => (viewport.view.hovered.value = null));
    life.listen<MouseEvent>(canvas, "dblclick", (e) => this.onDoubleClick(e));
    life.listen<WheelEvent>(canvas, "wheel", (e) => this.onWheel(e), { capture: true, passive: false });
    life.listen(canvas, "contextmenu", (e) => e.preventDefault());
    life.listen(document, "visibilitychange", () => {
      if (document.hidden) {
        studio.rest();
      }
    });
  }

  dispose(): void {
    this.life.end();
  }

  private locate(event: MouseEvent): Point {
    const box = this.viewport.canvas.getBoundingClientRect();
    this.at = { x: event.clientX - box.left, y: event.clientY - box.top };
    return this.at;
  }

  private pick(): PickHit | null {
    return this.viewport.product.pick(this.viewport.rayAt(this.at.x, this.at.y));
  }

  private ray(): Ray {
    return plain(this.viewport.rayAt(this.at.x, this.at.y));
  }

  private onDown(event: PointerEvent): void {
    this.fingers.press(event);
    if (!event.isPrimary) {
      if (this.gesture.kind === "drag" || this.gesture.kind === "pinch") {
        this.start(event, { kind: "pinch" });
        event.stopImmediatePropagation();
      }
      return;
    }
    const { x, y } = this.locate(event);
    this.viewport.canvas.focus({ preventScroll: true });
    this.viewport.product.explode.endOpening();
    const { view, hand } = this.viewport;
    const hit = this.pick();
    if (hit !== null) {
      hand.turnTo(hit.occurrence);
    }
    const isOnHeld = hit !== null && hand.mouse.holds(hit.occurrence);
    if (event.button === 2) {
      this.rightPress = { x: event.clientX, y: event.clientY };
    }
    if (isOnHeld && (event.button === 2 || (event.button === 0 && event.shiftKey))) {
      this.start(event, { kind: "turn", x, y });
    } else if (isOnHeld && event.button === 0) {
      this.start(event, { kind: "drag" });
      hand.mouse.grab(this.ray(), this.viewport.eye);
    } else if (event.button === 0) {
      const cube = this.viewport.pickCube(x, y);
      if (cube !== null) {
        this.viewport.rig.lookFrom(cube, this.viewport.product.outline());
        event.stopImmediatePropagation();
        return;
      }
      if (view.tool.peek() === "hand" && this.viewport.workshop.press(this.viewport.rayAt(x, y), hit?.distance ?? Infinity)) {
        this.start(event, { kind: "bench" });
        return;
      }
      const takes = view.tool.peek() === "hand" && hit !== null && this.canDrag(hit.occurrence);
      this.start(event, { kind: "press", x, y, hit, takes }, takes);
    }
  }

  /** What is in its place is taken out only where it was selected before: a drag on it looks around. */
  private canDrag(occurrence: number): boolean {
    const { view, hand } = this.viewport;
    const placement = this.studio.store.placements.peek().get(occurrence);
    const isOffered = placement === "loose" || (placement === "placed" && view.selected.peek().includes(occurrence));
    return isOffered ? hand.canTake(occurrence) : hand.isLeftInHand(occurrence);
  }

  private start(event: PointerEvent, gesture: Gesture, stopsEye = gesture.kind !== "press"): void {
    this.gesture = gesture;
    if (stopsEye) {
      this.viewport.rig.controls.enabled = false;
      this.viewport.canvas.setPointerCapture(event.pointerId);
    }
  }

  private onMove(event: PointerEvent): void {
    const { hand, product } = this.viewport;
    if (this.gesture.kind === "pinch") {
      const { eye } = this.viewport;
      this.fingers.lead(event, hand.mouse, eye, eye.metresPerPixel(product.sphere.center.toArray()));
      return;
    }
    this.fingers.move(event);
    if (!event.isPrimary && this.fingers.count !== 1) {
      return;
    }
    const { x, y } = this.locate(event);
    const gesture = this.gesture;
    switch (gesture.kind) {
      case "none":
        this.hover(event);
        break;
      case "taking":
        break;
      case "press":
        if (gesture.takes && Math.hypot(x - gesture.x, y - gesture.y) > kClickPx && gesture.hit !== null) {
          this.gesture = { kind: "taking", x: gesture.x, y: gesture.y };
          void this.takeAndDrag(gesture.hit.occurrence, event.altKey, gesture.x, gesture.y);
        }
        break;
      case "drag":
        hand.mouse.drag(this.ray(), this.viewport.eye, event.altKey);
        break;
      case "bench":
        this.viewport.workshop.drag(this.viewport.rayAt(x, y));
        break;
      case "turn": {
        const fine = event.altKey ? 0.2 : 1;
        const turn = kTurnPerPx * fine;
        hand.mouse.turn((y - gesture.y) * turn, (x - gesture.x) * turn, 0, this.viewport.eye);
        this.gesture = { kind: "turn", x, y };
        break;
      }
    }
  }

  private async takeAndDrag(occurrence: number, isAlone: boolean, x: number, y: number): Promise<void> {
    const hasTaken = await this.viewport.hand.take(occurrence, isAlone);
    if (this.gesture.kind === "taking") {
      this.gesture = hasTaken ? { kind: "drag" } : { kind: "none" };
    }
    if (hasTaken) {
      // As if the hand had been there when the pointer was pressed.
      this.viewport.hand.mouse.grab(plain(this.viewport.rayAt(x, y)), this.viewport.eye);
      this.viewport.hand.mouse.drag(this.ray(), this.viewport.eye, false);
      if (this.gesture.kind !== "drag") {
        this.viewport.hand.mouse.drop();
      }
    }
  }

  private onUp(event: PointerEvent): void {
    this.fingers.lift(event);
    if (this.gesture.kind === "pinch") {
      this.endPinch();
      return;
    }
    if (!event.isPrimary && this.gesture.kind !== "drag") {
      return;
    }
    this.locate(event);
    const gesture = this.gesture;
    this.finish();
    if (event.button === 2 && this.rightPress !== null) {
      const moved = Math.hypot(event.clientX - this.rightPress.x, event.clientY - this.rightPress.y);
      this.rightPress = null;
      if (moved <= kClickPx) {
        this.onContextMenu(event.clientX, event.clientY, this.pick());
      }
    } else if (gesture.kind === "press" && Math.hypot(this.at.x - gesture.x, this.at.y - gesture.y) <= kClickPx) {
      this.clicks.click(event, gesture.hit);
    }
  }

  /** The finger that is left goes on to drag, from where it is. */
  private endPinch(): void {
    const left = this.fingers.first;
    if (left === null) {
      this.finish();
      return;
    }
    const box = this.viewport.canvas.getBoundingClientRect();
    this.at = { x: left.x - box.left, y: left.y - box.top };
    this.gesture = { kind: "drag" };
    this.viewport.hand.mouse.drop();
    this.viewport.hand.mouse.grab(this.ray(), this.viewport.eye);
  }

  private finish(): void {
    this.gesture = { kind: "none" };
    this.viewport.rig.controls.enabled = true;
    this.viewport.hand.mouse.drop();
    this.viewport.workshop.drop();
  }

  private onDoubleClick(event: MouseEvent): void {
    this.locate(event);
    const hit = this.pick();
    const tool = this.viewport.view.tool.peek();
    if (hit === null) {
      return;
    }
    if (tool === "hand" && this.viewport.hand.mouse.holds(hit.occurrence)) {
      this.viewport.hand.release();
    } else if (tool === "hand") {
      void this.viewport.hand.take(hit.occurrence, event.altKey);
    } else if (tool === "select") {
      this.viewport.fit([hit.occurrence]);
    }
  }

  private onWheel(event: WheelEvent): void {
    if (this.gesture.kind !== "drag" && this.gesture.kind !== "bench") {
      return;
    }
    event.preventDefault();
    event.stopImmediatePropagation();
    if (this.gesture.kind === "bench") {
      this.viewport.workshop.turn(Math.sign(event.deltaY) * kBenchTurn);
      return;
    }
    const { product, hand, eye } = this.viewport;
    const step = 0.0004 * product.sphere.radius * (event.altKey ? 0.2 : 1);
    hand.mouse.nudge(0, 0, -event.deltaY * step, eye);
  }

  private hover(event: PointerEvent): void {
    if (event.buttons !== 0 || event.pointerType === "touch") {
      return;
    }
    const now = performance.now();
    if (now - this.lastHover < kHoverMs) {
      return;
    }
    this.lastHover = now;
    const hit = this.pick();
    const { view, hand, canvas } = this.viewport;
    view.hovered.value = hit?.occurrence ?? null;
    const isHeld = hit !== null && hand.mouse.holds(hit.occurrence);
    const canDrag = isHeld || (hit !== null && view.tool.peek() === "hand" && this.canDrag(hit.occurrence));
    canvas.style.cursor = canDrag ? "grab" : hit !== null ? "pointer" : "default";
  }
}
