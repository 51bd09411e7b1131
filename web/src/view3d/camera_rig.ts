/** The eye: orbit, standard views, perspective or parallel. W is Z up. */

import CameraControls from "camera-controls";
import {
  Box3,
  Matrix4,
  OrthographicCamera,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Sphere,
  Spherical,
  Vector2,
  Vector3,
  Vector4,
} from "three";
import { frame, kNoRim, type Frame, type Rim } from "../model/framing";
import type { Vec3 } from "../model/math";
import { boxOf } from "./goals";

CameraControls.install({
  THREE: { Vector2, Vector3, Vector4, Quaternion, Matrix4, Spherical, Box3, Sphere, Raycaster },
});

export type ViewName = "front" | "back" | "left" | "right" | "top" | "bottom" | "iso";

export interface EyePose {
  eye: Vec3;
  target: Vec3;
}

const kDirections: Record<ViewName, Vec3> = {
  front: [0, -1, 0],
  back: [0, 1, 0],
  left: [-1, 0, 0],
  right: [1, 0, 0],
  top: [0, 0, 1],
  bottom: [0, 0, -1],
  iso: [0.62, -0.95, 0.62],
};
const kFieldOfView = 32;
/** What stands around a small product is to be seen as well [m]. */
const kFarWall = 15;
/** How many times as large as what is shown the free part of the picture is: a choice. */
const kRoom = 1.08;

export class CameraRig {
  readonly perspective = new PerspectiveCamera(kFieldOfView, 1, 0.001, 100);
  readonly parallel = new OrthographicCamera(-1, 1, 1, -1, -10, 100);
  readonly controls: CameraControls;
  /** What panels cover of the picture. */
  rim: () => Rim = () => kNoRim;
  private aspect = 1;
  private beginning: EyePose | null = null;

  constructor(element: HTMLElement) {
    this.perspective.up.set(0, 0, 1);
    this.parallel.up.set(0, 0, 1);
    this.perspective.position.set(0.3, -0.5, 0.3);
    this.controls = new CameraControls(this.perspective, element);
    this.controls.updateCameraUp();
    this.controls.smoothTime = 0.18;
    this.controls.draggingSmoothTime = 0.06;
    this.controls.dollySpeed = 0.7;
    this.controls.dollyToCursor = true;
    this.controls.mouseButtons.wheel = CameraControls.ACTION.DOLLY;
    this.controls.mouseButtons.right = CameraControls.ACTION.TRUCK;
    this.controls.mouseButtons.middle = CameraControls.ACTION.TRUCK;
  }

  dispose(): void {
    this.controls.dispose();
  }

  get camera(): PerspectiveCamera | OrthographicCamera {
    return this.isParallel ? this.parallel : this.perspective;
  }

  get isParallel(): boolean {
    return this.controls.camera === this.parallel;
  }

  setReducedMotion(isReduced: boolean): void {
    this.controls.smoothTime = isReduced ? 0.001 : 0.18;
    this.controls.draggingSmoothTime = isReduced ? 0.001 : 0.06;
  }

  resize(width: number, height: number): void {
    this.aspect = width / Math.max(1, height);
    this.perspective.aspect = this.aspect;
    this.perspective.updateProjectionMatrix();
    const half = (this.parallel.top - this.parallel.bottom) / 2;
    this.setHalfHeight(half);
  }

  /** Near and far for a product of this size. */
  setReach(radius: number): void {
    this.perspective.near = radius / 200;
    this.perspective.far = Math.max(kFarWall, radius * 60);
    this.perspective.updateProjectionMatrix();
    this.parallel.near = -radius * 30;
    this.parallel.far = radius * 60;
    this.controls.minDistance = radius / 50;
    this.controls.maxDistance = radius * 14;
    this.parallel.updateProjectionMatrix();
  }

  setParallel(isParallel: boolean): void {
    if (isParallel === this.isParallel) {
      return;
    }
    const target = this.controls.getTarget(new Vector3());
    const eye = this.controls.getPosition(new Vector3());
    const half = Math.tan((kFieldOfView * Math.PI) / 360) * eye.distanceTo(target);
    if (isParallel) {
      this.setHalfHeight(half);
      this.parallel.position.copy(eye);
      this.controls.camera = this.parallel;
      void this.controls.zoomTo(1, false);
    } else {
      const seen = (this.parallel.top - this.parallel.bottom) / 2 / this.parallel.zoom;
      const distance = seen / Math.tan((kFieldOfView * Math.PI) / 360);
      eye.sub(target).setLength(distance).add(target);
      this.controls.camera = this.perspective;
    }
    void this.controls.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, false);
  }

  /** Looks from a direction so that all the points are in the picture, and no panel covers them. */
  lookFrom(direction: Vec3, points: readonly Vector3[], isSmooth = true): void {
    if (points.length === 0) {
      return;
    }
    const back = new Vector3(...direction).normalize();
    if (Math.abs(back.z) > 0.999) {
      // From straight above, x is to be right.
      back.y -= 1e-4 * Math.sign(back.z);
      back.normalize();
    }
    const middle = boxOf(points).getCenter(new Vector3());
    const right = new Vector3(0, 0, 1).cross(back).normalize();
    const up = back.clone().cross(right);
    const framed = (slope: number | null): Frame => {
      const screen = { right: right.toArray(), up: up.toArray(), back: back.toArray(), aspect: this.aspect, rim: this.rim(), room: kRoom };
      return frame(points.map((p) => p.toArray()), middle.toArray(), screen, slope);
    };
    const seen = framed(Math.tan((kFieldOfView * Math.PI) / 360));
    const shown = this.isParallel ? framed(null) : seen;
    const target = middle.clone().addScaledVector(right, shown.aside).addScaledVector(up, shown.above);
    const eye = target.clone().addScaledVector(back, seen.size);
    void this.controls.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, isSmooth);
    if (this.isParallel) {
      this.setHalfHeight(shown.size);
      void this.controls.zoomTo(1, isSmooth);
    }
  }

  /** As the product is seen before its user has moved the eye. */
  begin(direction: Vec3, points: readonly Vector3[]): void {
    this.lookFrom(direction, points, false);
    this.beginning = this.pose();
  }

  /** Whether the eye has not been moved since begin(). */
  isWhereItBegan(): boolean {
    const now = this.pose();
    const numbers = ({ eye, target }: EyePose): number[] => [...eye, ...target];
    const from = this.beginning === null ? [] : numbers(this.beginning);
    const most = 1e-6 * this.controls.distance;
    return from.length > 0 && numbers(now).every((value, k) => Math.abs(value - from[k]!) <= most);
  }

  view(name: ViewName, points: readonly Vector3[], isSmooth = true): void {
    this.lookFrom(kDirections[name], points, isSmooth);
  }

  /** Shows the points from where the eye is now. */
  fit(points: readonly Vector3[], isSmooth = true): void {
    const target = this.controls.getTarget(new Vector3());
    const direction = this.controls.getPosition(new Vector3()).sub(target);
    this.lookFrom(direction.toArray(), points, isSmooth);
  }

  /** Around what is looked at [rad]. */
  turn(aside: number, down: number): void {
    void this.controls.rotate(aside, down, true);
  }

  /** @param share  Of the distance, or of what is seen. */
  approach(share: number): void {
    if (this.isParallel) {
      void this.controls.zoomTo(this.parallel.zoom / share, true);
    } else {
      void this.controls.dollyTo(this.controls.distance * share, true);
    }
  }

  pose(): EyePose {
    const eye = this.controls.getPosition(new Vector3());
    const target = this.controls.getTarget(new Vector3());
    return { eye: eye.toArray(), target: target.toArray() };
  }

  setPose(eye: Vec3, target: Vec3): void {
    void this.controls.setLookAt(...eye, ...target, false);
  }

  /** Metres that a pixel covers at this depth. */
  metresPerPixel(depth: number, height: number): number {
    if (this.isParallel) {
      return (this.parallel.top - this.parallel.bottom) / this.parallel.zoom / height;
    }
    return (2 * Math.tan((kFieldOfView * Math.PI) / 360) * depth) / height;
  }

  private setHalfHeight(half: number): void {
    this.parallel.top = half;
    this.parallel.bottom = -half;
    this.parallel.left = -half * this.aspect;
    this.parallel.right = half * this.aspect;
    this.parallel.updateProjectionMatrix();
  }
}
