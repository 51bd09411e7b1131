/** The cube in the corner that shows and sets from where one looks. */

import {
  BoxGeometry,
  CanvasTexture,
  EdgesGeometry,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  Vector4,
  type Camera,
  type WebGLRenderer,
} from "three";
import type { Vec3 } from "../model/math";
import { disposeTree } from "./lifetime";
import type { Palette } from "./palette";

/** Names of the faces in the order of BoxGeometry: +x, -x, +y, -y, +z, -z. */
export type CubeLabels = readonly [string, string, string, string, string, string];

/** How each label is turned so that it reads upright, quarter turns against the clock. */
const kTurns = [1, 3, 2, 0, 0, 2];
const kPixels = 92;
const kMargin = 10;
/** Beyond this share of the half side a click means the edge or the corner. */
const kRim = 0.62;

export class ViewCube {
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(28, 1, 0.1, 20);
  private readonly cube: Mesh<BoxGeometry, MeshBasicMaterial[]>;
  private readonly rim: LineSegments<EdgesGeometry, LineBasicMaterial>;
  private labels: CubeLabels = ["", "", "", "", "", ""];

  constructor() {
    const box = new BoxGeometry(1, 1, 1);
    this.cube = new Mesh(box, Array.from({ length: 6 }, () => new MeshBasicMaterial({ transparent: true })));
    this.rim = new LineSegments(new EdgesGeometry(box), new LineBasicMaterial());
    this.scene.add(this.cube, this.rim);
    this.camera.up.set(0, 0, 1);
  }

  dispose(): void {
    disposeTree(this.scene);
  }

  setLabels(labels: CubeLabels, palette: Palette): void {
    this.labels = labels;
    this.setPalette(palette);
  }

  setPalette(palette: Palette): void {
    this.cube.material.forEach((material, k) => {
      material.map?.dispose();
      material.map = makeLabel(this.labels[k] ?? "", kTurns[k] ?? 0, palette);
      material.opacity = 0.94;
      material.needsUpdate = true;
    });
    this.rim.material.color.set(palette.cubeEdge);
  }

  render(renderer: WebGLRenderer, eye: Camera, width: number, height: number): void {
    const before = renderer.getViewport(new Vector4());
    this.aim(eye);
    renderer.clearDepth();
    const { x, y } = corner(width);
    renderer.setViewport(x, height - y - kPixels, kPixels, kPixels);
    renderer.render(this.scene, this.camera);
    renderer.setViewport(before);
  }

  /** The direction to look from when the pixel (from the top left) is clicked; null: beside the cube. */
  pick(px: number, py: number, width: number): Vec3 | null {
    const { x, y } = corner(width);
    const at = new Vector2((2 * (px - x)) / kPixels - 1, 1 - (2 * (py - y)) / kPixels);
    if (Math.abs(at.x) > 1 || Math.abs(at.y) > 1) {
      return null;
    }
    const caster = new Raycaster();
    caster.setFromCamera(at, this.camera);
    const hit = caster.intersectObject(this.cube)[0];
    if (hit === undefined) {
      return null;
    }
    const signs = hit.point.toArray().map((v) => (Math.abs(v) > 0.5 * kRim ? Math.sign(v) : 0));
    return [signs[0] ?? 0, signs[1] ?? 0, signs[2] ?? 0];
  }

  private aim(eye: Camera): void {
    const back = new Vector3();
    eye.getWorldDirection(back).negate();
    this.camera.position.copy(back.multiplyScalar(3.9));
    this.camera.quaternion.copy(eye.quaternion);
    this.camera.updateMatrixWorld();
  }
}

function corner(width: number): { x: number; y: number } {
  return { x: width - kPixels - kMargin, y: kMargin };
}

function makeLabel(text: string, turns: number, palette: Palette): CanvasTexture {
  const size = 128;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = palette.cubeFace;
  pen.fillRect(0, 0, size, size);
  pen.translate(size / 2, size / 2);
  pen.rotate((-turns * Math.PI) / 2);
  pen.fillStyle = palette.cubeInk;
  pen.font = `600 ${text.length > 6 ? 24 : 30}px Inter, system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(text, 0, 0);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = "srgb";
  texture.anisotropy = 4;
  return texture;
}
