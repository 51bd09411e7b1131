/** Faces that are marked, and what was measured. */

import {
  BufferGeometry,
  DoubleSide,
  Group,
  Line,
  LineBasicMaterial,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import type { Measurement } from "../protocol/messages";
import { disposeShapes } from "./lifetime";
import type { Palette } from "./palette";
import type { PartShape } from "./part_shape";

/** A point further from the product than so many radii is not drawn. */
const kFarthest = 50;

export interface MarkedFace {
  shape: PartShape;
  /** Of its part; followed as the part moves. */
  matrix: Matrix4;
  face: number;
}

export class MarkLayer {
  readonly root = new Group();
  /** Where the text of the measurement belongs, in W. */
  anchor: Vector3 | null = null;
  private readonly faces = new Group();
  private readonly measured = new Group();
  private readonly faceMaterial = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.55,
    side: DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -2,
  });
  private readonly lineMaterial = new LineBasicMaterial({ depthTest: false, transparent: true });
  private readonly dotMaterial = new MeshBasicMaterial({ depthTest: false, transparent: true });
  private readonly dot = new SphereGeometry(1, 12, 8);
  private radius = 0.1;

  constructor() {
    this.root.add(this.faces, this.measured);
  }

  setPalette(palette: Palette): void {
    this.faceMaterial.color.copy(palette.face);
    this.lineMaterial.color.copy(palette.measure);
    this.dotMaterial.color.copy(palette.measure);
  }

  setRadius(radius: number): void {
    this.radius = radius;
  }

  showFaces(faces: readonly MarkedFace[]): void {
    this.clearFaces();
    for (const { shape, matrix, face } of faces) {
      const mesh = new Mesh(shape.faceGeometry(face), this.faceMaterial);
      mesh.matrixAutoUpdate = false;
      mesh.matrix = matrix;
      mesh.renderOrder = 4;
      mesh.onBeforeRender = () => mesh.matrixWorld.copy(matrix);
      this.faces.add(mesh);
    }
  }

  showMeasurement(measurement: Measurement | null): void {
    this.clearMeasured();
    const points = (measurement?.p_m ?? []).map((p) => new Vector3(...p));
    // Lines that are all but parallel meet where nobody looks.
    const isInSight = points.every((p) => p.length() < kFarthest * this.radius);
    if (points.length === 0 || !isInSight) {
      return;
    }
    for (const point of points) {
      const dot = new Mesh(this.dot, this.dotMaterial);
      dot.position.copy(point);
      dot.scale.setScalar(0.011 * this.radius);
      dot.renderOrder = 33;
      this.measured.add(dot);
    }
    const line = new Line(new BufferGeometry().setFromPoints(points), this.lineMaterial);
    line.renderOrder = 32;
    this.measured.add(line);
    this.anchor = points.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(points.length);
  }

  clear(): void {
    this.clearFaces();
    this.clearMeasured();
  }

  dispose(): void {
    this.clear();
    this.dot.dispose();
    [this.faceMaterial, this.lineMaterial, this.dotMaterial].forEach((material) => material.dispose());
    this.root.removeFromParent();
  }

  private clearFaces(): void {
    disposeShapes(this.faces);
    this.faces.clear();
  }

  private clearMeasured(): void {
    this.anchor = null;
    if (this.measured.children.length > 0) {
      disposeShapes(this.measured);
      this.measured.clear();
    }
  }
}
