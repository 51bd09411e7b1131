/** The product drawn apart: all of it by a slider, or step by step against the order of assembly; with the
 way of each part as a line. */

import { BufferAttribute, BufferGeometry, LineDashedMaterial, LineSegments, type Color } from "three";
import { takenOut, takingApart } from "../model/apart";
import { explodeOffsets, type Box } from "../model/explode";
import { add, lerp, scale, slerp, type Pose, type Vec3 } from "../model/math";
import type { ViewState } from "../model/view_state";
import type { Scene, Step } from "../protocol/messages";
import { disposeTree } from "./lifetime";
import type { Parts } from "./parts";

/** Of the slider: so much of it brings what lies about to its place in the picture. */
const kGathered = 0.08;
/** Of what is left of the way, a picture. */
const kGlide = 0.22;
const kArrived = 0.002;
/** A product that is opened comes apart onto the table in so long [ms], first outward, then down: choices. */
const kOpeningMs = 2000;
const kOutward = 0.45;
const kOpeningShare = 0.6;

/** From 0 to 1, beginning and ending slowly. */
function ease(t: number): number {
  const share = Math.min(1, Math.max(0, t));
  return share * share * (3 - 2 * share);
}

export class ExplodeLayer {
  readonly lines = new LineSegments(
    new BufferGeometry(),
    new LineDashedMaterial({ transparent: true, opacity: 0.8, dashSize: 0.004, gapSize: 0.003 }),
  );
  private scene: Scene | null = null;
  private offsets = new Map<number, Vec3>();
  private boxes: ReadonlyMap<number, Box> = new Map();
  private apart: readonly Step[] = [];
  /** How far out each part is drawn, of its offset. */
  private readonly shares = new Map<number, number>();
  private shown = "";
  private isGliding = false;
  private openedMs: number | null = null;

  constructor(private readonly view: ViewState) {
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 5;
    this.lines.visible = false;
  }

  dispose(): void {
    disposeTree(this.lines);
  }

  /** Whether parts are drawn elsewhere than they are. */
  get isOn(): boolean {
    return this.view.explode.peek() > 0 || this.view.apart.peek() !== null || this.shown !== "" || this.openedMs !== null;
  }

  setInk(ink: Color): void {
    this.lines.material.color.copy(ink);
  }

  setProduct(scene: Scene, boxes: ReadonlyMap<number, Box>): void {
    this.scene = scene;
    this.boxes = boxes;
    this.offsets = explodeOffsets(scene.steps, boxes);
    this.apart = takingApart(scene.steps);
    this.shares.clear();
    this.shown = "";
    this.lines.material.dashSize = 0.04 * scene.radius_m;
    this.lines.material.gapSize = 0.03 * scene.radius_m;
  }

  /** Shows the product whole, and then how it comes apart. */
  open(): void {
    this.openedMs = performance.now();
  }

  /** The parts are drawn where they are, from the next picture on. */
  endOpening(): void {
    this.openedMs = this.openedMs === null ? null : -Infinity;
  }

  /** @param poses  Where the parts are. @return Whether anything was drawn elsewhere. */
  update(poses: ReadonlyMap<number, Pose>, parts: Parts): boolean {
    if (this.openedMs !== null) {
      this.comeApart((performance.now() - this.openedMs) / kOpeningMs, poses, parts);
      return true;
    }
    const explode = this.view.explode.peek();
    const apart = this.view.apart.peek();
    const wanted = apart !== null ? `apart ${apart}` : explode > 0 ? `explode ${explode}` : "";
    if (this.scene === null || (wanted === this.shown && !this.isGliding)) {
      return false;
    }
    this.shown = wanted;
    const out = apart === null ? null : takenOut(this.apart, apart);
    const gathered = out !== null ? 1 : Math.min(1, explode / kGathered);
    for (const { id, goal } of this.scene.occurrences) {
      const share = out === null ? explode : this.glide(id, out.has(id) ? 1 : 0);
      this.shares.set(id, share);
      const now = poses.get(id) ?? goal;
      const away = add(goal.p, scale(this.offsets.get(id) ?? [0, 0, 0], share));
      parts.setPose(id, { p: lerp(now.p, away, gathered), q: slerp(now.q, goal.q, gathered) });
    }
    this.isGliding = out !== null && [...this.shares].some(([id, share]) => share !== (out.has(id) ? 1 : 0));
    this.drawLines();
    return true;
  }

  /** @param time  Share of the opening that has passed. */
  private comeApart(time: number, poses: ReadonlyMap<number, Pose>, parts: Parts): void {
    const share = kOpeningShare * ease(time / kOutward);
    const down = ease((time - kOutward) / (1 - kOutward));
    for (const { id, goal } of this.scene?.occurrences ?? []) {
      const now = poses.get(id) ?? goal;
      const out = add(goal.p, scale(this.offsets.get(id) ?? [0, 0, 0], share));
      parts.setPose(id, { p: lerp(out, now.p, down), q: slerp(goal.q, now.q, down) });
    }
    this.openedMs = time >= 1 ? null : this.openedMs;
  }

  private glide(id: number, to: number): number {
    const from = this.shares.get(id) ?? 0;
    const next = from + (to - from) * kGlide;
    return this.view.isCalm.peek() || Math.abs(to - next) < kArrived ? to : next;
  }

  private drawLines(): void {
    const points: number[] = [];
    for (const [id, share] of this.shares) {
      const box = this.boxes.get(id);
      const offset = this.offsets.get(id);
      if (share > kArrived && box !== undefined && offset !== undefined) {
        const middle = lerp(box.low, box.high, 0.5);
        points.push(...middle, ...add(middle, scale(offset, share)));
      }
    }
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
    this.lines.computeLineDistances();
    this.lines.visible = points.length > 0;
  }
}
