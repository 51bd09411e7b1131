/** The way of a part: a line with its points, or the room that the part sweeps. */

import {
  BufferGeometry,
  DoubleSide,
  Group,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import type { PartPaths, ShownPath } from "../model/part_path";
import { disposeShapes, Lifetime } from "./lifetime";
import type { Palette } from "./palette";

const kDotShare = 0.008;

export class PathLayer {
  readonly root = new Group();
  onChange: () => void = () => {};
  private readonly line = new LineBasicMaterial({ transparent: true, depthTest: false });
  private readonly dots = new MeshStandardMaterial({ roughness: 0.6 });
  private readonly sweep = new MeshStandardMaterial({
    transparent: true,
    opacity: 0.32,
    roughness: 0.7,
    side: DoubleSide,
    depthWrite: false,
  });
  private loadCount = 0;
  private radius = 0.1;
  private readonly life = new Lifetime();

  constructor(paths: PartPaths) {
    this.life.follow(() => void this.show(paths.shown.value));
  }

  dispose(): void {
    this.life.end();
    this.loadCount += 1;
    disposeShapes(this.root);
    [this.line, this.dots, this.sweep].forEach((material) => material.dispose());
    this.root.removeFromParent();
  }

  setPalette(palette: Palette): void {
    this.line.color.copy(palette.path);
    this.dots.color.copy(palette.path);
    this.sweep.color.copy(palette.path);
  }

  setRadius(radius: number): void {
    this.radius = radius;
  }

  private async show(path: ShownPath | null): Promise<void> {
    const turn = ++this.loadCount;
    const content =
      path?.kind === "swept"
        ? await this.loadSweep(path.swept?.glb ?? null)
        : path?.points
          ? this.drawPoints(path.points.points_m.map((p) => new Vector3(...p)))
          : null;
    if (turn !== this.loadCount) {
      return;
    }
    disposeShapes(this.root);
    this.root.clear();
    if (content !== null) {
      this.root.add(content);
    }
    this.onChange();
  }

  private drawPoints(points: readonly Vector3[]): Group {
    const line = new Line(new BufferGeometry().setFromPoints([...points]), this.line);
    line.renderOrder = 28;
    const dots = new InstancedMesh(new SphereGeometry(kDotShare * this.radius, 10, 8), this.dots, points.length);
    points.forEach((p, k) => dots.setMatrixAt(k, new Matrix4().setPosition(p)));
    dots.frustumCulled = false;
    return new Group().add(line, dots);
  }

  private async loadSweep(url: string | null): Promise<Group | null> {
    if (url === null) {
      return null;
    }
    const { scene } = await new GLTFLoader().loadAsync(url);
    scene.traverse((node) => {
      if (node instanceof Mesh) {
        node.material = this.sweep;
        node.renderOrder = 2;
      }
    });
    // glTF has its y upwards.
    const upright = new Group().add(scene);
    upright.rotation.x = Math.PI / 2;
    return upright;
  }
}
