/** Tells the others where this page looks and points to, and follows the view of one of them. */

import type { Studio } from "../model/studio";
import type { Vec3 } from "../model/math";
import { Lifetime } from "./lifetime";
import type { Viewport } from "./viewport";

/** Between two messages: as often as others can read it. A choice. */
const kTellMs = 100;

/** Shorter ways are not told [m]. */
const kStill = 1e-4;

function differs(a: readonly number[], b: readonly number[]): boolean {
  return a.length !== b.length || a.some((value, i) => Math.abs(value - b[i]!) > kStill);
}

export class SharedEyes {
  /** Where the pointer is [px]; null: not on the picture. */
  private at: { x: number; y: number } | null = null;
  private told: readonly number[] = [];
  private toldAt = 0;
  private readonly life = new Lifetime();
  private readonly stopFrames: () => void;
  /** What the eye was given last of the view that is followed; null: nothing yet. */
  private given: readonly number[] | null = null;

  constructor(
    private readonly viewport: Viewport,
    private readonly studio: Studio,
  ) {
    const { canvas } = viewport;
    this.life.listen<PointerEvent>(canvas, "pointermove", ({ offsetX, offsetY }) => (this.at = { x: offsetX, y: offsetY }));
    this.life.listen(canvas, "pointerleave", () => (this.at = null));
    this.stopFrames = viewport.onFrame((_live, now) => {
      this.follow();
      this.tell(now);
    });
  }

  dispose(): void {
    this.stopFrames();
    this.life.end();
  }

  private follow(): void {
    const { followed, looking } = this.studio.store;
    const seen = followed.peek() === null ? undefined : looking.peek().get(followed.peek()!);
    if (seen === undefined) {
      this.given = null;
      return;
    }
    const { eye, target } = this.viewport.rig.pose();
    const now = [...eye, ...target];
    const wanted = [...seen.eye_m, ...seen.target_m];
    if (this.given !== null && differs(now, this.given)) {
      followed.value = null; // Whoever moves the eye wants to look for himself.
    } else if (this.given === null || differs(now, wanted)) {
      this.viewport.rig.setPose(seen.eye_m, seen.target_m);
      this.viewport.invalidate();
      const given = this.viewport.rig.pose();
      this.given = [...given.eye, ...given.target];
    }
  }

  private tell(now: number): void {
    const { clients, link, study, replay } = this.studio.store;
    const isAlone = clients.peek().length < 2;
    if (now - this.toldAt < kTellMs || isAlone || link.peek() !== "open" || study.peek() !== null || replay.peek() !== null) {
      return;
    }
    const { eye, target } = this.viewport.rig.pose();
    const p = this.pointedAt();
    const next = [...eye, ...target, ...(p ?? [])];
    if (differs(next, this.told)) {
      this.told = next;
      this.toldAt = now;
      void this.studio.tell({ command: "look", eye, target, ...(p === null ? {} : { p }) });
    }
  }

  private pointedAt(): Vec3 | null {
    if (this.at === null) {
      return null;
    }
    const hit = this.viewport.product.pick(this.viewport.rayAt(this.at.x, this.at.y));
    return hit === null ? null : [hit.point.x, hit.point.y, hit.point.z];
  }
}
