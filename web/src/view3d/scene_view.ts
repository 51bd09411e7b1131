/** The product in the view: loads it, puts parts where the frames say, and shows what is marked. */

import { untracked } from "@preact/signals";
import { Group, Ray, Sphere, Vector3, type Box3 } from "three";
import { clearanceOf, type Box } from "../model/explode";
import { Extrapolator } from "../model/extrapolate";
import { toQuat, toVec3, type Pose } from "../model/math";
import { Seen } from "../model/seen";
import type { Store } from "../model/store";
import type { ViewState } from "../model/view_state";
import type { FrameStore, LiveState } from "../protocol/frame_store";
import { kMaxHands, kNone, type HandState } from "../protocol/frames";
import type { Occurrence, Scene, Step } from "../protocol/messages";
import { DeformedParts } from "./deformed_parts";
import { ArrowScale, FeelLayer } from "./feel_layer";
import { ExplodeLayer } from "./explode_layer";
import { boxesBut, centreOfMass, cornersOf, ghostsOf, goalBoxes, kHeadroom, withHeadroom } from "./goals";
import { loadShapes } from "./glb";
import { heldWith, posesInHand } from "./held_members";
import { Lifetime } from "./lifetime";
import { loadedAs, opensWhole, type Loaded } from "./loaded_as";
import { MarkLayer } from "./mark_layer";
import { markedFaces, shapesOfFaces } from "./marked_faces";
import type { Palette } from "./palette";
import { PartLooks } from "./part_looks";
import { Parts, type PickHit } from "./parts";
import { SectionCaps } from "./section_caps";

export class SceneView {
  readonly root = new Group();
  readonly arrowScale = new ArrowScale();
  readonly marks = new MarkLayer();
  readonly caps = new SectionCaps();
  readonly explode: ExplodeLayer;
  readonly sphere = new Sphere(new Vector3(), 0.1);
  parts: Parts | null = null;
  scene: Scene | null = null;
  isDirty = true;
  /** Called when a product has been loaded and stands in the view. */
  onLoaded: (loaded: Loaded) => void = () => {};
  private palette: Palette | null = null;
  private deformed: DeformedParts | null = null;
  private readonly versions = new Map<number, number>();
  private readonly poses = new Map<number, Pose>();
  private readonly seen = new Map<number, Seen>();
  private readonly looks: PartLooks;
  private readonly extrapolators = new Map<number, Extrapolator>();
  private boxes = new Map<number, Box>();
  private generation = -1;
  private loadCount = 0;
  private glbUrl = "";
  private readonly life = new Lifetime();
  private readonly feels = Array.from({ length: kMaxHands }, () => new FeelLayer(this.arrowScale));
  private readonly heldKeys = this.feels.map(() => "");

  constructor(
    private readonly store: Store,
    private readonly view: ViewState,
  ) {
    this.looks = new PartLooks(store, view);
    this.explode = new ExplodeLayer(view);
    this.root.add(...this.feels.map((feel) => feel.root), this.marks.root, this.explode.lines);
    // Only a new scene: what loading reads besides would load it again, and take the part out of the hand.
    this.life.follow(() => {
      const scene = store.scene.value;
      void untracked(() => this.load(scene));
    });
    this.life.follow(() => this.applyLooks());
    this.life.follow(() => this.applySection());
    this.life.follow(() => {
      this.parts?.setDrawn(view.showsEdges.value, view.hasRoomLight.value);
      this.arrowScale.isLocked = view.locksForceScale.value;
      this.isDirty = true;
    });
    this.life.follow(() => {
      this.marks.showMeasurement(view.measurement.value);
      this.markFaces();
    });
  }

  dispose(): void {
    this.life.end();
    this.loadCount += 1;
    this.clear();
    [...this.feels, this.marks, this.caps, this.explode, this.looks].forEach((each) => each.dispose());
    this.root.removeFromParent();
  }

  setPalette(palette: Palette): void {
    this.palette = palette;
    this.feels.forEach((feel) => feel.setPalette(palette));
    this.marks.setPalette(palette);
    this.explode.setInk(palette.axis);
    this.parts?.edges?.setInk(palette.edge, palette.edgeMarked);
    this.looks.setPalette(palette);
    this.applyLooks();
  }

  poseOf(occurrence: number): Pose | null {
    return this.poses.get(occurrence) ?? null;
  }

  occurrence(id: number): Occurrence | null {
    return this.store.occurrences.value.get(id) ?? null;
  }

  /** Corners of the boxes of what is seen, or of some parts. */
  outline(only?: readonly number[]): Vector3[] {
    return this.parts?.corners(only === undefined ? undefined : new Set(only)) ?? [];
  }

  /** Of what is to be seen at first: in a study also the place of the part at hand. */
  firstOutline(): Vector3[] {
    return [...withHeadroom(this.outline(), kHeadroom * this.sphere.radius), ...this.placeOf(this.store.study.peek()?.occurrence ?? -1)];
  }

  /** Corners of the box of a part in its place. */
  placeOf(occurrence: number): Vector3[] {
    return cornersOf(this.boxes.get(occurrence));
  }

  /** Boxes of the places of all parts but these. */
  placesOfOthers(ids: readonly number[]): Box3[] {
    return boxesBut(this.boxes, ids);
  }

  /** How far out a part has to be to be clear of all that is in its place already [m]. */
  clearance(step: Step): number {
    const isPlaced = (id: number) => this.store.placements.peek().get(id) === "placed";
    return clearanceOf(step, this.boxes, [...this.boxes.keys()].filter(isPlaced));
  }

  pick(ray: Ray): PickHit | null {
    return this.parts?.raycast(ray, this.view.section.value === null ? [] : [this.caps.plane]) ?? null;
  }

  /** Puts everything where it is now. */
  update(frames: FrameStore | null, live: LiveState | null, nowMs: number): void {
    if (this.parts === null || this.scene === null) {
      return;
    }
    const isCurrent = live !== null && live.epoch === this.scene.epoch;
    if (frames !== null && isCurrent) {
      this.takePoses(frames);
      this.moveHeld(live, nowMs);
      this.isDirty = this.deformed?.update(frames, this.parts) || this.isDirty;
    }
    this.isDirty = this.explode.update(this.poses, this.parts) || this.isDirty;
    this.updateFeel(isCurrent ? live : null);
    this.isDirty = this.looks.pulse(this.parts) || this.isDirty;
    if (this.view.section.value !== null) {
      this.caps.update(this.parts);
    }
  }

  private async load(scene: Scene | null): Promise<void> {
    const turn = ++this.loadCount;
    if (scene === null) {
      return this.clear();
    }
    const loaded = loadedAs(scene, this.scene);
    if (this.parts === null || this.glbUrl !== scene.glb || this.deformed?.isOf(scene) !== true) {
      const shapes = await this.store.followMeshes(scene.glb_bytes, (tell) => loadShapes(scene.glb, tell));
      if (turn !== this.loadCount) {
        return;
      }
      this.clear();
      this.deformed = new DeformedParts(shapes, scene);
      this.parts = new Parts(this.deformed.shapes);
      this.root.add(this.parts.root);
      this.glbUrl = scene.glb;
    }
    this.scene = scene;
    this.parts.setScene(scene);
    this.forgetPoses();
    this.sphere.set(new Vector3(...scene.centre_m), scene.radius_m);
    this.arrowScale.fit(scene.radius_m);
    this.feels.forEach((feel) => feel.setRadius(scene.radius_m));
    this.marks.setRadius(scene.radius_m);
    for (const occurrence of scene.occurrences) {
      const pose = occurrence.placement === "loose" ? occurrence.start : occurrence.goal;
      this.poses.set(occurrence.id, pose);
      this.parts.setPose(occurrence.id, pose);
    }
    this.boxes = goalBoxes(scene, this.parts);
    this.explode.setProduct(scene, this.boxes);
    this.heldKeys.fill("");
    this.looks.clear();
    if (this.palette !== null) {
      this.parts.edges?.setInk(this.palette.edge, this.palette.edgeMarked);
    }
    this.parts.setDrawn(this.view.showsEdges.peek(), this.view.hasRoomLight.peek());
    this.applyLooks();
    this.applySection();
    this.isDirty = true;
    if (loaded === "new" && opensWhole(scene, this.store, this.view)) {
      this.explode.open();
    }
    this.onLoaded(loaded);
  }

  private clear(): void {
    this.caps.clear();
    this.marks.clear();
    this.feels.forEach((feel) => feel.setHeld([], []));
    if (this.parts !== null) {
      this.root.remove(this.parts.root);
      this.parts.dispose();
    }
    this.parts = this.deformed = null;
    this.scene = null;
    this.glbUrl = "";
    this.poses.clear();
    this.looks.clear();
    this.isDirty = true;
  }

  /** All of them are to be taken from the frames again. */
  forgetPoses(): void {
    this.versions.clear();
    this.seen.clear();
    this.extrapolators.clear();
    this.deformed?.forget();
    this.generation = -1;
  }

  private takePoses(frames: FrameStore): void {
    if (frames.generation === this.generation) {
      return;
    }
    this.generation = frames.generation;
    const buffer = new Float32Array(7);
    for (const entry of this.parts!.entries) {
      const version = frames.poseVersion(entry.occurrence);
      if (version === 0 || this.versions.get(entry.occurrence) === version) {
        continue;
      }
      this.versions.set(entry.occurrence, version);
      frames.readPose(entry.occurrence, buffer);
      this.place(entry.occurrence, { p: toVec3(buffer), q: toQuat(buffer, 3) });
    }
  }

  private place(occurrence: number, pose: Pose): void {
    this.poses.set(occurrence, pose);
    const seen = this.seen.get(occurrence) ?? new Seen();
    this.seen.set(occurrence, seen);
    if (!seen.differs([...pose.p, ...pose.q])) {
      return;
    }
    if (!this.explode.isOn) {
      this.parts!.setPose(occurrence, pose);
    }
    this.isDirty = true;
  }

  /** What is in a hand is drawn where it must be by now: sight is to lag no more than it has to. */
  private moveHeld(live: LiveState, nowMs: number): void {
    for (const hand of live.hands) {
      if (hand.occurrence === kNone || hand.state === 0) {
        this.extrapolators.delete(hand.hand);
        continue;
      }
      const extrapolator = this.extrapolators.get(hand.hand) ?? new Extrapolator();
      this.extrapolators.set(hand.hand, extrapolator);
      extrapolator.take({ p: toVec3(hand.p_WD_m), q: toQuat(hand.q_WD) }, live.sentMs);
      const pose = extrapolator.at(nowMs);
      if (pose !== null) {
        posesInHand(this.store, hand.occurrence, pose).forEach(([part, at]) => this.place(part, at));
      }
    }
  }

  private updateFeel(live: LiveState | null): void {
    const isWhole = !this.explode.isOn;
    const shows = this.view.showsForces.peek() && isWhole;
    this.feels.forEach((feel, k) => {
      const hand = live?.hands.find((h) => h.hand === k && h.state > 0 && h.occurrence !== kNone) ?? null;
      const key = hand === null ? "" : [hand.occurrence, ...heldWith(this.store, hand.occurrence)].join();
      if (key !== this.heldKeys[k]) {
        this.heldKeys[k] = key;
        this.showGhosts(feel, hand);
        this.isDirty = true;
      }
      const contacts = live?.contacts.filter((contact) => contact.hand === k) ?? [];
      feel.setGoalShown(hand !== null && hand.state < 5 && isWhole);
      const centre = hand === null ? null : centreOfMass(this.occurrence(hand.occurrence), this.poses.get(hand.occurrence));
      this.isDirty = feel.update(hand, contacts, centre, shows) || this.isDirty;
    });
  }

  private showGhosts(feel: FeelLayer, hand: HandState | null): void {
    if (hand === null || this.parts === null || this.scene === null) {
      feel.setHeld([], []);
      return;
    }
    const { goal, tracked } = ghostsOf(hand.occurrence, heldWith(this.store, hand.occurrence), this.scene, this.parts);
    feel.setHeld(goal, tracked);
  }

  private markFaces(): void {
    this.marks.showFaces(shapesOfFaces(markedFaces(this.view, this.scene?.mates ?? []), this.parts));
    this.isDirty = true;
  }

  private applyLooks(): void {
    this.isDirty = this.looks.apply(this.parts) || this.isDirty;
  }

  private applySection(): void {
    const section = this.view.section.value;
    if (section !== null) {
      this.caps.place(section, this.sphere);
    }
    this.parts?.setClipping(section === null ? [] : [this.caps.plane]);
    this.isDirty = true;
  }
}
