/** One of the two hands of somebody in VR: a controller, or the bare hand with its 25 joints. */

import {
  CapsuleGeometry,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  Raycaster,
  SphereGeometry,
  TorusGeometry,
  Vector3,
  type Object3D,
  type Ray,
  type WebXRManager,
  type XRHandSpace,
  type XRTargetRaySpace,
} from "three";
import type { Pose } from "../../model/math";
import type { Pulse } from "../../model/vibration";
import { disposeTree } from "../lifetime";

/** Radius of what is drawn of a joint whose size is not known, and least of all [m]. */
const kJoint = 0.006;
const kJoints = 25;
const kIdle = 0x8d99ab;
const kHolding = 0x58b0ff;

type GrabKind = "trigger" | "squeeze" | "pinch";
/** What a runtime may have of vibration. */
type Vibrating = Gamepad & {
  hapticActuators?: readonly { pulse?(strength: number, ms: number): Promise<boolean> }[];
};

export class UserHand {
  onGrab: (kind: GrabKind) => void = () => {};
  onRelease: () => void = () => {};
  source: XRInputSource | null = null;
  private readonly grip: Group;
  private readonly ray: XRTargetRaySpace;
  private readonly hand: XRHandSpace;
  private readonly material = new MeshStandardMaterial({ color: kIdle, roughness: 0.55 });
  private readonly joints = new InstancedMesh(new SphereGeometry(1, 12, 8), this.material, kJoints);
  private readonly caster = new Raycaster();
  private grabbedBy: GrabKind | null = null;

  constructor(
    readonly index: number,
    xr: WebXRManager,
    parent: Object3D,
  ) {
    this.grip = xr.getControllerGrip(index);
    this.ray = xr.getController(index);
    this.hand = xr.getHand(index);
    this.joints.frustumCulled = false;
    this.joints.count = 0;
    const room = new Group().add(this.joints);
    const handle = makeHandle(this.material);
    this.grip.add(handle);
    parent.add(this.grip, this.ray, this.hand, room);
    this.removeAll = () => {
      disposeTree(room);
      disposeTree(handle);
      for (const group of [this.grip, this.ray, this.hand, room]) {
        group.removeFromParent();
      }
    };
    this.listen();
  }

  readonly dispose = (): void => {
    for (const [type, listener] of this.listeners) {
      this.ray.removeEventListener(type, listener);
    }
    this.removeAll();
  };

  /** Bare, without a controller in it. */
  get isBare(): boolean {
    return this.source?.hand != null;
  }

  /** Whether it is known where it is. */
  get isTracked(): boolean {
    if (this.source === null) {
      return false;
    }
    return this.isBare ? this.hand.joints.wrist?.visible === true : this.grip.visible;
  }

  get isGrabbing(): boolean {
    return this.grabbedBy !== null;
  }

  get handedness(): XRHandedness {
    return this.source?.handedness ?? "none";
  }

  /** Of the point with which it takes hold, in the room. */
  get position(): Vector3 {
    if (!this.isBare) {
      return new Vector3().setFromMatrixPosition(this.grip.matrixWorld);
    }
    const tip = (name: XRHandJoint) => this.hand.joints[name]?.position ?? new Vector3();
    return tip("thumb-tip").clone().add(tip("index-finger-tip")).multiplyScalar(0.5);
  }

  /** Turns with the controller, or with the wrist: fingertips tremble. */
  get orientation(): Quaternion {
    const of = this.isBare ? this.hand.joints.wrist : this.grip;
    return new Quaternion().setFromRotationMatrix(new Matrix4().extractRotation(of?.matrixWorld ?? new Matrix4()));
  }

  /** In the frame of `world`, which may be scaled. */
  poseIn(world: Group): Pose {
    const scale = new Vector3();
    const turn = new Quaternion();
    world.matrixWorld.decompose(new Vector3(), turn, scale);
    const q = turn.invert().multiply(this.orientation);
    return { p: world.worldToLocal(this.position).toArray(), q: [q.w, q.x, q.y, q.z] };
  }

  /** Where it points, in the room. */
  get pointer(): Ray {
    this.caster.ray.origin.setFromMatrixPosition(this.ray.matrixWorld);
    this.caster.ray.direction.set(0, 0, -1).transformDirection(this.ray.matrixWorld);
    return this.caster.ray;
  }

  /** Where a panel on the wrist is fixed. */
  get wrist(): Matrix4 {
    return (this.isBare ? this.hand.joints.wrist?.matrixWorld : this.grip.matrixWorld) ?? new Matrix4();
  }

  /** A stick pushed aside: -1 to 1; 0 for a bare hand. */
  get stickX(): number {
    const axes = this.source?.gamepad?.axes ?? [];
    return (axes.length >= 4 ? axes[2] : axes[0]) ?? 0;
  }

  /** Whether a button that takes hold is down now: events may have been missed. */
  get isPressed(): boolean {
    return this.source?.gamepad?.buttons.slice(0, 2).some((b) => b.pressed) ?? false;
  }

  pulse({ strength, ms }: Pulse): void {
    const gamepad = this.source?.gamepad as Vibrating | undefined;
    const actuator = gamepad?.hapticActuators?.[0];
    if (actuator?.pulse !== undefined) {
      void actuator.pulse(strength, ms);
    } else {
      void gamepad?.vibrationActuator?.playEffect?.("dual-rumble", { duration: ms, strongMagnitude: strength });
    }
  }

  draw(isHolding: boolean): void {
    this.material.color.set(isHolding ? kHolding : kIdle);
    this.joints.count = 0;
    if (!this.isBare) {
      return;
    }
    const matrix = new Matrix4();
    for (const joint of Object.values(this.hand.joints)) {
      if (joint?.visible) {
        const radius = Math.max(kJoint, joint.jointRadius ?? kJoint);
        matrix.makeScale(radius, radius, radius).setPosition(joint.position);
        this.joints.setMatrixAt(this.joints.count++, matrix);
      }
    }
    this.joints.instanceMatrix.needsUpdate = true;
  }

  private readonly removeAll: () => void;
  private readonly listeners: [EventName, (event: object) => void][] = [];

  private listen(): void {
    const on = (type: EventName, listener: (event: object) => void): void => {
      this.listeners.push([type, listener]);
      this.ray.addEventListener(type, listener);
    };
    on("connected", (event) => (this.source = (event as { data: XRInputSource }).data));
    on("disconnected", () => {
      this.source = null;
      this.grabbedBy = null;
    });
    // Only start and end: some runtimes fire the short events at the press.
    on("selectstart", () => this.grab("trigger"));
    on("selectend", () => this.letGo("trigger"));
    on("squeezestart", () => this.grab("squeeze"));
    on("squeezeend", () => this.letGo("squeeze"));
    on("pinchstart", () => this.grab("pinch"));
    on("pinchend", () => this.letGo("pinch"));
  }

  /** A runtime may tell of a pinch as a select as well: of a bare hand only its joints count. */
  private isMeant(kind: GrabKind): boolean {
    return (kind === "pinch") === this.isBare;
  }

  private grab(kind: GrabKind): void {
    if (this.isMeant(kind) && this.grabbedBy === null) {
      this.grabbedBy = kind;
      this.onGrab(kind);
    }
  }

  private letGo(kind: GrabKind): void {
    if (this.grabbedBy === kind) {
      this.grabbedBy = null;
      this.onRelease();
    }
  }
}

type EventName =
  | "connected"
  | "disconnected"
  | "selectstart"
  | "selectend"
  | "squeezestart"
  | "squeezeend"
  | "pinchstart"
  | "pinchend";

/** A handle with a ring: enough to see where the controller is. */
function makeHandle(material: MeshStandardMaterial): Group {
  const handle = new Mesh(new CapsuleGeometry(0.016, 0.07, 6, 16), material);
  handle.rotation.x = -0.5;
  const ring = new Mesh(new TorusGeometry(0.034, 0.006, 10, 28), material);
  ring.position.set(0, 0.01, -0.05);
  ring.rotation.x = Math.PI / 2 - 0.4;
  return new Group().add(handle, ring);
}
