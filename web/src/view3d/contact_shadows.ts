/** The dark rim where a part lies on the table, where little light gets to: one soft spot below each part. */

import { Box3, InstancedBufferAttribute, InstancedBufferGeometry, Matrix4, Mesh, PlaneGeometry, ShaderMaterial } from "three";

/** How dark it is below a part that touches the table: a choice. */
const kDarkest = 0.5;
/** A part keeps the light away from a rim as wide as this share of its height, or of its smaller side: a choice. */
const kMargin = 0.35;
/** The least darkness below a flat part, as a share: through a gasket one sees the table. A choice. */
const kFlattest = 0.25;
/** A part so high above the table, as a share of its smaller side, has a spot of 1/e: a choice. */
const kFade = 0.7;

const kVertex = /* glsl */ `
  attribute vec4 spot;
  attribute float dark;
  varying vec2 vPlace;
  varying float vDark;
  void main() {
    vPlace = 2.0 * position.xy;
    vDark = dark;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(spot.xy + vPlace * spot.zw, 0.0, 1.0);
    if (dark < 0.01) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
  }
`;

const kFragment = /* glsl */ `
  varying vec2 vPlace;
  varying float vDark;
  void main() {
    vec2 square = vPlace * vPlace;
    float rim = 1.0 - min(1.0, square.x * square.x + square.y * square.y);
    gl_FragColor = vec4(0.0, 0.0, 0.0, vDark * rim * rim);
  }
`;

const world = new Box3();

export class ContactShadows {
  readonly object: Mesh;
  private readonly geometry = new InstancedBufferGeometry();
  private readonly material = new ShaderMaterial({
    vertexShader: kVertex,
    fragmentShader: kFragment,
    transparent: true,
    depthWrite: false,
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -1,
  });
  private readonly spots: InstancedBufferAttribute;
  private readonly darks: InstancedBufferAttribute;

  constructor(count: number) {
    const plane = new PlaneGeometry(1, 1);
    this.geometry.setIndex(plane.index).setAttribute("position", plane.getAttribute("position"));
    this.spots = new InstancedBufferAttribute(new Float32Array(4 * count), 4);
    this.darks = new InstancedBufferAttribute(new Float32Array(count), 1);
    this.geometry.setAttribute("spot", this.spots).setAttribute("dark", this.darks);
    this.geometry.instanceCount = count;
    this.object = new Mesh(this.geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = -1; // before all else that is transparent
  }

  /** @param z  Of the table [m]. */
  setTable(z: number): void {
    this.object.position.z = z;
  }

  /** @param box  Of the part, in its frame, which stands at `matrix`. */
  place(instance: number, box: Box3, matrix: Matrix4, isSeen: boolean): void {
    const { min, max } = world.copy(box).applyMatrix4(matrix);
    const table = this.object.position.z;
    const [x, y] = [(max.x - min.x) / 2, (max.y - min.y) / 2];
    const half = Math.min(x, y);
    const isOverTable = isSeen && max.z > table;
    const gap = Math.max(0, min.z - table);
    const upright = Math.min(1, (max.z - min.z) / half);
    const margin = kMargin * Math.min(half, max.z - min.z);
    this.spots.setXYZW(instance, (min.x + max.x) / 2, (min.y + max.y) / 2, x + margin, y + margin);
    const dark = kDarkest * Math.max(kFlattest, upright) * Math.exp(-gap / (kFade * 2 * half));
    this.darks.setX(instance, isOverTable ? dark : 0);
    this.spots.needsUpdate = this.darks.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }
}
