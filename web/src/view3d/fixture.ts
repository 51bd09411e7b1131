/** The vise in which the first part stands, or the plate on which a flat one lies: as large as the part, and as high as
 the table is below it. */

import { Box3, BoxGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, Vector3, type BufferGeometry } from "three";

/** Shares of the part's size: choices, as a machine vise looks. */
const kFoot = 1.2;
const kFootHeight = 0.25;
const kBody = 0.86;
const kJaw = 0.14;
const kJawHeight = 0.16;
/** What is flatter than this share of its width lies on a plate: no jaw could hold it. */
const kFlat = 0.3;
/** A lower gap under the part needs no fixture [m]. */
const kLeastHeight = 1e-3;

export class Fixture {
  readonly root = new Group();
  private readonly cast = new MeshStandardMaterial({ roughness: 0.62, metalness: 0.25 });
  private readonly steel = new MeshStandardMaterial({ roughness: 0.35, metalness: 0.55 });

  setDark(isDark: boolean): void {
    this.cast.color.set(isDark ? 0x3d5166 : 0x5b7288);
    this.steel.color.set(isDark ? 0x8b97a6 : 0xb4bdc8);
  }

  /** @param base    Box of what stands in the fixture.
   @param others  Boxes of what will be beside it: where they are, no jaw can be. */
  place(tableZ: number, base: Box3, others: readonly Box3[]): void {
    this.clear();
    const height = base.min.z - tableZ;
    if (base.isEmpty() || height < kLeastHeight) {
      return;
    }
    const size = base.getSize(new Vector3());
    const middle = base.getCenter(new Vector3());
    const foot = kFootHeight * height;
    this.add(new BoxGeometry(kFoot * size.x, kFoot * size.y, foot), this.cast, middle.x, middle.y, tableZ + foot / 2);
    this.add(new BoxGeometry(kBody * size.x, kBody * size.y, height - foot), this.cast, middle.x, middle.y, (tableZ + foot + base.min.z) / 2);
    if (size.z < kFlat * Math.max(size.x, size.y)) {
      return;
    }
    this.addJaws(base, size, others);
    const radius = 0.3 * (height - foot);
    const spindle = new CylinderGeometry(radius, radius, 0.3 * size.y, 32);
    this.add(spindle, this.steel, middle.x, base.min.y + (0.5 - 0.5 * kBody - 0.13) * size.y, (tableZ + foot + base.min.z) / 2);
  }

  dispose(): void {
    this.clear();
    this.cast.dispose();
    this.steel.dispose();
  }

  /** Both jaws or none, in front and behind, as the spindle closes them. */
  private addJaws(base: Box3, size: Vector3, others: readonly Box3[]): void {
    const thick = kJaw * size.y;
    const high = kJawHeight * size.z;
    const x = (base.min.x + base.max.x) / 2;
    const half = 0.5 * kBody * size.x;
    const jaws = [base.min.y - thick, base.max.y].map(
      (y) => new Box3(new Vector3(x - half, y, base.min.z - high), new Vector3(x + half, y + thick, base.min.z + high)),
    );
    if (jaws.some((jaw) => others.some((other) => other.intersectsBox(jaw)))) {
      return;
    }
    for (const jaw of jaws) {
      const extent = jaw.getSize(new Vector3());
      const at = jaw.getCenter(new Vector3());
      this.add(new BoxGeometry(extent.x, extent.y, extent.z), this.steel, at.x, at.y, at.z);
    }
  }

  private add(geometry: BufferGeometry, material: MeshStandardMaterial, x: number, y: number, z: number): void {
    const mesh = new Mesh(geometry, material);
    mesh.position.set(x, y, z - 1e-4);
    mesh.castShadow = mesh.receiveShadow = true;
    this.root.add(mesh);
  }

  private clear(): void {
    for (const child of [...this.root.children]) {
      (child as Mesh).geometry.dispose();
      this.root.remove(child);
    }
  }
}
