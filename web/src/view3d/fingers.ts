/** Two fingers on a part: it turns as they do, and comes nearer as they part. */

import type { Eye, MouseHand } from "./mouse_hand";

const kTurnPerPx = 0.004;

export interface Point {
  x: number;
  y: number;
}

export class Fingers {
  /** By their ids, the first one first [px]. */
  private readonly down = new Map<number, Point>();

  get count(): number {
    return this.down.size;
  }

  get first(): Point | null {
    return [...this.down.values()][0] ?? null;
  }

  press(event: PointerEvent): void {
    if (event.pointerType === "touch") {
      this.down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    }
  }

  lift(event: PointerEvent): void {
    this.down.delete(event.pointerId);
  }

  move(event: PointerEvent): void {
    const finger = this.down.get(event.pointerId);
    if (finger !== undefined) {
      Object.assign(finger, { x: event.clientX, y: event.clientY });
    }
  }

  /** One of two has moved: their middle tilts the part, their line turns it, and their distance moves it along the
   line of sight.
   @param metresPerPixel  Where the part is. */
  lead(event: PointerEvent, hand: MouseHand, eye: Eye, metresPerPixel: number): void {
    const finger = this.down.get(event.pointerId);
    const other = [...this.down.values()].find((each) => each !== finger);
    if (finger === undefined || other === undefined) {
      return;
    }
    const to = { x: event.clientX, y: event.clientY };
    const before = { x: finger.x - other.x, y: finger.y - other.y };
    const after = { x: to.x - other.x, y: to.y - other.y };
    const twist = Math.atan2(before.x * after.y - before.y * after.x, before.x * after.x + before.y * after.y);
    hand.turn((to.y - finger.y) * kTurnPerPx, (to.x - finger.x) * kTurnPerPx, -twist, eye);
    const apart = Math.hypot(after.x, after.y) - Math.hypot(before.x, before.y);
    hand.nudge(0, 0, -apart * metresPerPixel, eye);
    Object.assign(finger, to);
  }
}
