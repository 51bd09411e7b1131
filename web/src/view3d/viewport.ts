/** The 3D view as a whole: renderer, loop, eye, hand. What the rest of the page asks of it is here. */

import { Group, PerspectiveCamera, Ray, Raycaster, Sphere, Vector2, Vector3, Scene as ThreeScene, type Color, type WebGLRenderer } from "three";
import type { Vec3 } from "../model/math";
import type { PartPaths } from "../model/part_path";
import type { Studio } from "../model/studio";
import type { SharedView } from "../model/view_link";
import type { ViewState } from "../model/view_state";
import { nowMs, type LiveState } from "../protocol/frame_store";
import { CameraGuide } from "./camera_guide";
import { CameraRig, type ViewName } from "./camera_rig";
import { makeEye } from "./eye";
import { firstDirection } from "./first_direction";
import { FrameMeter } from "./frame_meter";
import { boxOf } from "./goals";
import { HandControl } from "./hand_control";
import { Lifetime } from "./lifetime";
import type { Loaded } from "./loaded_as";
import type { Eye } from "./mouse_hand";
import { Painter } from "./painter";
import { readPalette } from "./palette";
import { copyPicture } from "./picture";
import { PathLayer } from "./path_layer";
import { PointerInput } from "./pointer_input";
import { makeRenderer } from "./renderer";
import { SceneView } from "./scene_view";
import { applyView, readView } from "./shared_view";
import { Stage } from "./stage";
import { ViewCube, type CubeLabels } from "./view_cube";
import type { Room } from "./vr/host";
import { WorkshopHost } from "./workshop_host";

/** A still picture is drawn this often all the same. */
const kIdleMs = 500;
/** Between two inputs of the hand. */
const kHandMs = 15;

export type FrameListener = (live: LiveState | null, now: number) => void;

export class Viewport {
  readonly canvas = document.createElement("canvas");
  readonly renderer: WebGLRenderer;
  readonly rig: CameraRig;
  readonly product: SceneView;
  readonly hand: HandControl;
  readonly pointer: PointerInput;
  readonly workshop: WorkshopHost;
  readonly guide: CameraGuide;
  framesDrawn = 0;
  readonly meter = new FrameMeter();
  live: LiveState | null = null;
  /** Nobody sees the picture, so it is not drawn. */
  isResting = false;
  /** All of W; VR turns and scales it. */
  readonly worldRoot = new Group();
  /** Of somebody in VR; the rig's cameras are the desktop's. */
  readonly vrEyes = new PerspectiveCamera(70, 1, 0.03, 60);
  /** While somebody is in VR. */
  room: Room | null = null;
  private readonly three = new ThreeScene();
  private readonly stage = new Stage();
  private readonly cube = new ViewCube();
  private readonly painter: Painter;
  private readonly listeners = new Set<FrameListener>();
  private readonly life = new Lifetime();
  private readonly caster = new Raycaster();
  private width = 1;
  private height = 1;
  private lastTick = 0;
  private lastMove = 0;
  private lastDrawn = 0;
  private lastSeq = -1;
  private lastEpoch = -1;
  private pathLayer: PathLayer | null = null;
  private pendingView: SharedView | null = null;

  constructor(
    readonly host: HTMLElement,
    private readonly studio: Studio,
    readonly view: ViewState,
  ) {
    this.renderer = makeRenderer(this.canvas);
    host.append(this.canvas);
    this.rig = new CameraRig(this.canvas);
    this.product = new SceneView(studio.store, view);
    this.worldRoot.add(this.stage.root, this.product.root);
    this.three.add(this.worldRoot);
    this.painter = new Painter(this.renderer, this.three, this.rig, this.product, this.cube, view);
    this.workshop = new WorkshopHost(this.worldRoot, view);
    this.workshop.onChange = () => this.showGrid();
    this.hand = new HandControl(studio, this.product, view);
    this.pointer = new PointerInput(this, studio);
    this.product.onLoaded = (loaded) => this.onLoaded(loaded);
    this.life.followSize(host, () => this.resize());
    this.guide = new CameraGuide(this, studio, view);
    this.followState();
    this.resize();
    this.renderer.setAnimationLoop((now) => this.tick(now));
    this.life.repeat(kHandMs, () => this.moveHand(performance.now()));
  }

  /** Ends the picture: nothing of it is drawn, listened to or kept on the graphics card any more. */
  dispose(): void {
    void this.renderer.xr.getSession()?.end();
    this.renderer.setAnimationLoop(null);
    this.life.end();
    this.listeners.clear();
    const own = [this.guide, this.pointer, this.hand, this.workshop, this.product, this.stage, this.cube, this.painter, this.rig];
    own.forEach((each) => each.dispose());
    this.pathLayer?.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }

  get eye(): Eye {
    return makeEye(this.rig, this.caster, this.height);
  }

  onFrame(listener: FrameListener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  invalidate(): void {
    this.product.isDirty = true;
  }

  /** The ray of a pixel, counted from the top left of the canvas. */
  rayAt(x: number, y: number): Ray {
    this.caster.setFromCamera(new Vector2((2 * x) / this.width - 1, 1 - (2 * y) / this.height), this.rig.camera);
    return this.caster.ray.clone();
  }

  /** Where a point of W is seen: pixels from the top left of the canvas. */
  project(p: Vec3): { x: number; y: number; isBehind: boolean } {
    const at = new Vector3(...p).project(this.rig.camera);
    return { x: ((at.x + 1) / 2) * this.width, y: ((1 - at.y) / 2) * this.height, isBehind: at.z > 1 };
  }

  pickCube(x: number, y: number): Vec3 | null {
    return this.view.showsCube.peek() ? this.cube.pick(x, y, this.width) : null;
  }

  refreshTheme(labels: CubeLabels): void {
    const palette = readPalette(this.host);
    this.stage.setPalette(palette);
    this.product.setPalette(palette);
    this.pathLayer?.setPalette(palette);
    this.cube.setLabels(labels, palette);
    this.invalidate();
  }

  showPaths(paths: PartPaths): void {
    this.pathLayer?.dispose();
    this.pathLayer = new PathLayer(paths);
    this.pathLayer.onChange = () => this.invalidate();
    this.worldRoot.add(this.pathLayer.root);
  }

  /** Somebody is in VR from now on. */
  enterRoom(background: Color, room: Room): void {
    this.three.background = background;
    this.room = room;
  }

  leaveRoom(): void {
    this.three.background = null;
    this.room = null;
    this.resize();
  }

  fit(only?: readonly number[]): void {
    this.rig.fit(this.product.outline(only?.length ? only : undefined));
    this.invalidate();
  }

  /** As the product is seen at first, and until its user moves the eye. */
  lookAnew(): void {
    if (this.product.scene !== null) {
      this.rig.begin(firstDirection(this.product.scene), this.product.firstOutline());
      this.invalidate();
    }
  }

  lookFrom(name: ViewName): void {
    this.rig.view(name, this.product.outline());
    this.invalidate();
  }

  /** A view that was shared by link; waits for the product where it is not there yet. */
  show(view: SharedView): void {
    if (this.product.parts === null) {
      this.pendingView = view;
      return;
    }
    this.pendingView = null;
    applyView(view, this.view, this.rig);
    this.invalidate();
  }

  sharedView(): SharedView {
    return readView(this.view, this.rig);
  }

  /** The picture as it is now, on the page's background. */
  screenshot(): Promise<Blob | null> {
    this.draw();
    return copyPicture(this.canvas, this.host);
  }

  private followState(): void {
    const { view, life } = this;
    life.follow(() => {
      this.rig.setParallel(view.isOrthographic.value);
      this.invalidate();
    });
    life.follow(() => {
      const isFine = view.isFine.value;
      this.stage.setShadows(isFine, this.renderer);
      this.renderer.setPixelRatio(isFine ? Math.min(2, devicePixelRatio) : 1);
      this.resize();
    });
    life.follow(() => this.showGrid());
    life.follow(() => {
      void view.stereo.value;
      this.resize();
      this.rig.fit(this.product.outline(), false);
    });
  }

  private showGrid(): void {
    this.stage.setGridShown(this.view.showsGrid.value && !this.workshop.isShown);
    this.invalidate();
  }

  private onLoaded(loaded: Loaded): void {
    const scene = this.product.scene!;
    const around = boxOf(this.product.outline()).getBoundingSphere(new Sphere());
    const fixed = scene.occurrences.filter((o) => o.is_base).map((o) => o.id);
    this.stage.fit(around, scene.radius_m, scene.table_z_m, boxOf(this.product.outline(fixed)), this.product.placesOfOthers(fixed));
    this.workshop.fit(around, scene.table_z_m);
    this.pathLayer?.setRadius(scene.radius_m);
    this.rig.setReach(Math.max(scene.radius_m, 0.5 * around.radius));
    if (this.pendingView !== null) {
      this.show(this.pendingView);
    } else if (loaded === "new" || (loaded === "completed" && this.rig.isWhereItBegan())) {
      this.lookAnew();
    }
    this.guide.showNext();
    this.hand.stop();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.host;
    this.width = Math.max(1, clientWidth);
    this.height = Math.max(1, clientHeight);
    this.renderer.setSize(this.width, this.height, false);
    // Side by side, each eye has half of the width.
    const isAsAtFirst = this.rig.isWhereItBegan() && !this.hand.isBusy;
    this.rig.resize(this.view.stereo.peek() === "side" ? this.width / 2 : this.width, this.height);
    if (isAsAtFirst) {
      this.lookAnew();
    }
    // The canvas is empty after a change of its size: not to be seen.
    this.draw();
  }

  private tick(now: number): void {
    const seconds = Math.min(0.1, (now - this.lastTick) / 1000);
    this.lastTick = now;
    const playback = this.studio.recordings.playback.peek();
    playback?.tick(now);
    const frames = this.studio.frames;
    this.live = frames?.read() ?? this.live;
    const live = this.live;
    if (live !== null && (live.seq !== this.lastSeq || live.epoch !== this.lastEpoch)) {
      this.lastSeq = live.seq;
      this.lastEpoch = live.epoch;
      if (live.epoch === this.product.scene?.epoch) {
        this.studio.noteHands(live);
      }
    }
    // What was recorded is drawn as it was: only of what is live it is guessed where it is by now.
    this.guide.tick(seconds);
    this.product.update(frames, live, playback === null ? nowMs() : (live?.sentMs ?? 0));
    const hasMoved = this.rig.controls.update(seconds);
    const isDue = this.renderer.xr.isPresenting || now - this.lastDrawn > kIdleMs;
    if (!this.isResting && (hasMoved || this.product.isDirty || isDue)) {
      this.product.isDirty = false;
      this.draw();
      this.lastDrawn = now;
      this.view.isSlow.value ||= this.meter.drawn(now);
      this.view.isFast.value ||= this.meter.isFast;
    } else {
      this.meter.rested();
    }
    this.room?.update(now);
    for (const listener of this.listeners) {
      listener(live, now);
    }
  }

  /** By a clock of its own: on a machine that draws slowly the hand still moves smoothly. */
  private moveHand(now: number): void {
    const seconds = Math.min(0.1, (now - this.lastMove) / 1000);
    this.lastMove = now;
    if (this.hand.isBusy) {
      this.live = this.studio.frames?.read() ?? this.live;
      this.hand.update(seconds, this.live, this.eye);
    }
  }

  draw(): void {
    this.painter.draw(this.width, this.height, this.vrEyes);
    this.framesDrawn += 1;
  }
}
