/** Immersive VR: both controllers take parts, lead them, and vibrate with what they push against. */

import {
  Box3,
  Color,
  Group,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Quaternion,
  Sphere,
  SphereGeometry,
  Vector3,
  type XRTargetRaySpace,
} from "three";
import type { Pose } from "../model/math";
import { compose, inverse } from "../model/math";
import type { Studio } from "../model/studio";
import type { HandInput } from "../protocol/frames";
import type { Viewport } from "./viewport";

/** All parts lie within arms' reach: this large, this high, this far before the eyes [m]. */
const kSeenRadius = 0.5;
const kHeight = 1.15;
const kAhead = -0.75;
/** A product is shown no larger than so many times its size. */
const kLargest = 3;
/** Parts nearer than this to the controller can be taken, in metres of the room. */
const kReach = 0.12;
const kPulseMs = 30;
/** Radius of what is drawn of a hand [m]. */
const kTip = 0.014;

interface Grip {
  index: number;
  space: Group;
  ray: XRTargetRaySpace;
  source: XRInputSource | null;
  /** The hand in the frame of the controller, once it holds something. */
  X_CH: Pose | null;
  occurrence: number | null;
  isWaiting: boolean;
  lastPulse: number;
}

function poseIn(object: Group, world: Group): Pose {
  const matrix = new Matrix4().copy(world.matrixWorld).invert().multiply(object.matrixWorld);
  const p = new Vector3();
  const q = new Quaternion();
  matrix.decompose(p, q, new Vector3());
  return { p: p.toArray(), q: [q.w, q.x, q.y, q.z] };
}

function pulse(source: XRInputSource | null, strength: number, ms: number): void {
  const gamepad = source?.gamepad as
    | (Gamepad & { hapticActuators?: readonly { pulse?(strength: number, ms: number): Promise<boolean> }[] })
    | undefined;
  const actuator = gamepad?.hapticActuators?.[0];
  if (actuator?.pulse !== undefined) {
    void actuator.pulse(strength, ms);
  } else {
    void gamepad?.vibrationActuator?.playEffect?.("dual-rumble", { duration: ms, strongMagnitude: strength });
  }
}

class VrHands {
  private readonly grips: Grip[];

  constructor(
    private readonly port: Viewport,
    private readonly studio: Studio,
    private readonly world: Group,
  ) {
    const { xr } = port.renderer;
    this.grips = [0, 1].map((index) => {
      const grip: Grip = {
        index,
        space: xr.getControllerGrip(index),
        ray: xr.getController(index),
        source: null,
        X_CH: null,
        occurrence: null,
        isWaiting: false,
        lastPulse: 0,
      };
      // Only start and end: some runtimes fire the short events at the press.
      grip.ray.addEventListener("connected", (event) => (grip.source = event.data));
      grip.ray.addEventListener("disconnected", () => this.release(grip));
      for (const kind of ["select", "squeeze"] as const) {
        grip.ray.addEventListener(`${kind}start`, () => void this.take(grip));
        grip.ray.addEventListener(`${kind}end`, () => this.release(grip));
      }
      return grip;
    });
    for (const grip of this.grips) {
      grip.space.add(new Mesh(new SphereGeometry(kTip, 16, 12), new MeshBasicMaterial({ color: 0x9cc8ff })));
      world.parent?.add(grip.space, grip.ray);
    }
  }

  update(): void {
    const inputs: HandInput[] = [];
    for (const grip of this.grips) {
      if (grip.X_CH === null) {
        continue;
      }
      const hand = compose(poseIn(grip.space, this.world), grip.X_CH);
      inputs.push({ hand: grip.index, buttons: 1, p_WH_m: hand.p, q_WH: hand.q, client_ms: performance.now() % 1e6 });
      this.vibrate(grip);
    }
    if (inputs.length > 0) {
      this.studio.sendInput(inputs);
    }
  }

  dispose(): void {
    for (const grip of this.grips) {
      this.release(grip);
      grip.space.clear();
      grip.space.removeFromParent();
      grip.ray.removeFromParent();
    }
  }

  private nearest(grip: Grip): number | null {
    const parts = this.port.product.parts;
    const at = new Vector3().setFromMatrixPosition(grip.space.matrixWorld);
    const centre = new Vector3();
    const scale = this.world.scale.x;
    let best: number | null = null;
    let least = kReach;
    for (const entry of parts?.entries ?? []) {
      const part = this.port.product.occurrence(entry.occurrence);
      if (part === null || part.is_base || entry.look.isHidden) {
        continue;
      }
      centre.copy(entry.shape.sphere.center).applyMatrix4(entry.matrix).applyMatrix4(this.world.matrixWorld);
      const gap = centre.distanceTo(at) - 0.5 * entry.shape.sphere.radius * scale;
      if (gap < least) {
        least = gap;
        best = entry.occurrence;
      }
    }
    return best;
  }

  private async take(grip: Grip): Promise<void> {
    if (grip.X_CH !== null || grip.isWaiting) {
      return;
    }
    const occurrence = this.nearest(grip);
    if (occurrence === null) {
      return;
    }
    grip.isWaiting = true;
    const answer = await this.studio.command({ command: "take", hand: grip.index, occurrence });
    if (answer !== null) {
      grip.X_CH = compose(inverse(poseIn(grip.space, this.world)), answer.hand);
      grip.occurrence = occurrence;
      pulse(grip.source, 0.8, 40);
    }
    if (!grip.isWaiting) {
      // It was let go while the server answered.
      this.release(grip);
    }
    grip.isWaiting = false;
  }

  private release(grip: Grip): void {
    grip.isWaiting = false;
    if (grip.X_CH !== null) {
      grip.X_CH = null;
      grip.occurrence = null;
      this.studio.rest();
      void this.studio.command({ command: "release", hand: grip.index });
    }
  }

  /** A pulse takes the place of one that runs: so they are short, and as strong as the push. */
  private vibrate(grip: Grip): void {
    const hand = this.port.live?.hands.find((h) => h.hand === grip.index);
    const now = performance.now();
    if (hand === undefined || now - grip.lastPulse < kPulseMs) {
      return;
    }
    const newtons = Math.max(hand.peak_felt_n, Math.hypot(...hand.f_felt_W_n));
    if (newtons > 0.2) {
      grip.lastPulse = now;
      pulse(grip.source, Math.min(1, 0.1 + newtons / 8), kPulseMs + 10);
    }
  }
}

/** Enters VR and stays until the session ends. */
export async function startVr(port: Viewport, studio: Studio, onEnd: () => void): Promise<void> {
  const { renderer, product } = port;
  const session = await navigator.xr!.requestSession("immersive-vr", {
    optionalFeatures: ["local-floor", "hand-tracking"],
  });
  const world = port.worldRoot;
  const { center, radius } = new Box3().setFromPoints(product.outline()).getBoundingSphere(new Sphere());
  const scale = Math.min(kLargest, kSeenRadius / radius);
  // W is Z up, the room of the headset is Y up.
  world.rotation.set(-Math.PI / 2, 0, 0);
  world.scale.setScalar(scale);
  world.position.set(-center.x * scale, kHeight - center.z * scale, kAhead + center.y * scale);
  world.updateMatrixWorld(true);
  renderer.xr.enabled = true;
  renderer.xr.setReferenceSpaceType("local-floor");
  await renderer.xr.setSession(session);
  const hands = new VrHands(port, studio, world);
  port.setBackground(new Color(0x171c25));
  const stop = port.onFrame(() => hands.update());
  session.addEventListener("end", () => {
    stop();
    hands.dispose();
    renderer.xr.enabled = false;
    world.rotation.set(0, 0, 0);
    world.scale.setScalar(1);
    world.position.set(0, 0, 0);
    world.updateMatrixWorld(true);
    port.setBackground(null);
    onEnd();
  });
}
