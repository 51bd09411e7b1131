/** What the hand feels, made visible: force, torque, contacts, axis, where the part should be and where
 the hand would have it. */

import {
  BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  Group,
  InstancedMesh,
  LineDashedMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
  type Color,
} from "three";
import { kMaxContacts } from "../protocol/frame_store";
import type { ContactPoint, HandState } from "../protocol/frames";
import { toQuat, toVec3, type Pose } from "../model/math";
import { Seen } from "../model/seen";
import { disposeTree } from "./lifetime";
import type { Palette } from "./palette";
import type { PartShape } from "./part_shape";
import { toMatrix } from "./parts";

const kUp = new Vector3(0, 1, 0);
/** Below this no arrow is drawn [N, N m]. */
const kLeastForce = 0.02;
const kLeastTorque = 5e-4;

class Arrow {
  readonly root = new Group();
  private readonly shaft: Mesh;
  private readonly tip: Mesh;
  readonly material = new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.95 });

  constructor() {
    this.shaft = new Mesh(new CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0), this.material);
    this.tip = new Mesh(new ConeGeometry(1, 1, 20).translate(0, 0.5, 0), this.material);
    this.shaft.renderOrder = this.tip.renderOrder = 30;
    this.root.add(this.shaft, this.tip);
    this.root.visible = false;
  }

  show(at: Vector3, along: Vector3, length: number, thickness: number): void {
    this.root.visible = length > 1e-6;
    if (!this.root.visible) {
      return;
    }
    const tip = Math.min(0.4 * length, 5 * thickness);
    this.root.position.copy(at);
    this.root.quaternion.setFromUnitVectors(kUp, along);
    this.shaft.scale.set(thickness, length - tip, thickness);
    this.tip.position.y = length - tip;
    this.tip.scale.set(2.6 * thickness, tip, 2.6 * thickness);
  }
}

/** Shapes that stand somewhere as a whole: a part, or a subassembly held as one. */
export interface GhostPart {
  shape: PartShape;
  /** In W, or in the frame of the ghost. */
  pose: Pose;
}

class Ghost {
  readonly root = new Group();
  readonly material: MeshBasicMaterial;

  constructor(opacity: number) {
    this.material = new MeshBasicMaterial({ transparent: true, opacity, depthWrite: false });
    this.root.visible = false;
  }

  setParts(parts: readonly GhostPart[]): void {
    this.root.clear();
    for (const part of parts) {
      const mesh = new Mesh(part.shape.geometry, this.material);
      mesh.matrixAutoUpdate = false;
      toMatrix(part.pose, mesh.matrix);
      mesh.renderOrder = 3;
      this.root.add(mesh);
    }
  }
}

export interface ForceScale {
  /** Metres of arrow a newton. */
  perN: number;
  perNm: number;
}

/** How long arrows are: the same for both hands, so that their forces can be compared by eye. */
export class ArrowScale {
  isLocked = false;
  private radius = 0.1;
  private largestN = 4;

  fit(radius: number): void {
    this.radius = radius;
    this.largestN = 4;
  }

  take(forceN: number): void {
    if (!this.isLocked) {
      this.largestN = Math.max(this.largestN, forceN);
    }
  }

  share(forceN: number): number {
    return Math.min(1, forceN / this.largestN);
  }

  get now(): ForceScale {
    const longest = 0.65 * this.radius;
    return { perN: longest / this.largestN, perNm: longest / (0.25 * this.largestN * this.radius) };
  }
}

export class FeelLayer {
  readonly root = new Group();
  private readonly force = new Arrow();
  private readonly torque = new Arrow();
  private readonly goal = new Ghost(0.2);
  private readonly tracked = new Ghost(0.14);
  private readonly dots: InstancedMesh;
  private readonly axis: LineSegments<BufferGeometry, LineDashedMaterial>;
  private radius = 0.1;
  private readonly seen = new Seen();

  constructor(private readonly scale: ArrowScale) {
    this.dots = new InstancedMesh(
      new SphereGeometry(1, 12, 8),
      new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.95 }),
      kMaxContacts,
    );
    this.dots.count = 0;
    this.dots.frustumCulled = false;
    this.dots.renderOrder = 31;
    this.axis = new LineSegments(
      new BufferGeometry().setFromPoints([new Vector3(0, -1, 0), new Vector3(0, 1, 0)]),
      new LineDashedMaterial({ dashSize: 0.05, gapSize: 0.035, transparent: true, depthTest: false }),
    );
    this.axis.computeLineDistances();
    this.axis.renderOrder = 29;
    this.axis.visible = false;
    this.axis.frustumCulled = false;
    this.root.add(this.force.root, this.torque.root, this.goal.root, this.tracked.root, this.dots, this.axis);
  }

  /** Parts that it shows as ghosts are not its own. */
  dispose(): void {
    this.setHeld([], []);
    disposeTree(this.root);
    this.goal.material.dispose();
    this.tracked.material.dispose();
  }

  setPalette(palette: Palette): void {
    const set = (material: { color: Color }, color: Color) => material.color.copy(color);
    set(this.force.material, palette.force);
    set(this.torque.material, palette.torque);
    set(this.goal.material, palette.goal);
    set(this.tracked.material, palette.held);
    set(this.dots.material as MeshBasicMaterial, palette.contact);
    set(this.axis.material, palette.axis);
    this.goal.material.opacity = palette.isDark ? 0.2 : 0.3;
  }

  setRadius(radius: number): void {
    this.radius = radius;
  }

  /** @param goal  In W; `tracked` in the frame of the held part. Empty: nothing is held. */
  setHeld(goal: readonly GhostPart[], tracked: readonly GhostPart[]): void {
    this.goal.setParts(goal);
    this.tracked.setParts(tracked);
    this.goal.root.visible = goal.length > 0;
    this.tracked.root.visible = false;
  }

  setGoalShown(isShown: boolean): void {
    this.goal.root.visible = isShown && this.goal.root.children.length > 0;
  }

  /** @param at  Where the arrows start: the centre of mass of the held part, in W.
   @return Whether it looks otherwise than before. */
  update(hand: HandState | null, contacts: readonly ContactPoint[], at: Vector3 | null, showsForces: boolean): boolean {
    this.updateArrows(hand, at, showsForces);
    this.updateContacts(showsForces ? contacts : []);
    this.updateAxis(hand);
    const isHeld = hand !== null && hand.state > 0;
    const gap = isHeld ? Math.hypot(...hand.p_WT_m.map((v, k) => v - (hand.p_WD_m[k] ?? 0))) : 0;
    this.tracked.root.visible = isHeld && gap > 0.004 * this.radius;
    if (isHeld) {
      const pose = { p: toVec3(hand.p_WT_m), q: toQuat(hand.q_WT) };
      this.tracked.root.position.set(...pose.p);
      this.tracked.root.quaternion.copy(new Quaternion(pose.q[1], pose.q[2], pose.q[3], pose.q[0]));
    }
    return this.seen.differs(hand === null ? [] : this.describe(hand, contacts, at, showsForces));
  }

  /** What is drawn of a hand, in lengths. */
  private describe(hand: HandState, contacts: readonly ContactPoint[], at: Vector3 | null, showsForces: boolean): number[] {
    const { perN, perNm } = this.scale.now;
    return [
      hand.state,
      Number(showsForces),
      ...(at?.toArray() ?? []),
      ...hand.f_felt_W_n.map((v) => v * perN),
      ...hand.t_felt_W_nm.map((v) => v * perNm),
      ...hand.p_WT_m,
      ...hand.q_WT,
      ...hand.p_WD_m,
      ...hand.p_WAxis_m,
      ...hand.axis_W,
      ...contacts.flatMap(({ p_WC_m: p, f_C_W_n: f }) => [...p, Math.hypot(...f) * perN]),
    ];
  }

  private updateArrows(hand: HandState | null, at: Vector3 | null, showsForces: boolean): void {
    this.force.root.visible = this.torque.root.visible = false;
    if (hand === null || at === null || !showsForces) {
      return;
    }
    const f = new Vector3(...hand.f_felt_W_n);
    const t = new Vector3(...hand.t_felt_W_nm);
    this.scale.take(f.length());
    const { perN, perNm } = this.scale.now;
    const longest = 0.8 * this.radius;
    if (f.length() > kLeastForce) {
      const length = Math.min(longest, f.length() * perN);
      this.force.show(at, f.normalize(), length, 0.012 * this.radius);
    }
    if (t.length() > kLeastTorque) {
      const length = Math.min(longest, t.length() * perNm);
      this.torque.show(at, t.normalize(), length, 0.012 * this.radius);
    }
  }

  private updateContacts(contacts: readonly ContactPoint[]): void {
    const matrix = new Matrix4();
    this.dots.count = Math.min(contacts.length, kMaxContacts);
    for (let k = 0; k < this.dots.count; k++) {
      const contact = contacts[k]!;
      const size = this.radius * (0.009 + 0.009 * this.scale.share(Math.hypot(...contact.f_C_W_n)));
      matrix.makeScale(size, size, size).setPosition(...toVec3(contact.p_WC_m));
      this.dots.setMatrixAt(k, matrix);
    }
    this.dots.instanceMatrix.needsUpdate = true;
  }

  private updateAxis(hand: HandState | null): void {
    this.axis.visible = hand !== null && hand.state >= 2 && Math.hypot(...hand.axis_W) > 0.5;
    if (hand !== null && this.axis.visible) {
      this.axis.position.set(...toVec3(hand.p_WAxis_m));
      this.axis.quaternion.setFromUnitVectors(kUp, new Vector3(...hand.axis_W).normalize());
      this.axis.scale.setScalar(1.6 * this.radius);
    }
  }
}
