/** All parts of the product: drawn in one batch, those that are ghosts in another. */

import {
  BatchedMesh,
  type BufferGeometry,
  Color,
  DoubleSide,
  FrontSide,
  Group,
  Matrix4,
  MeshStandardMaterial,
  Quaternion,
  Vector3,
  Vector4,
  type Plane,
  type Ray,
} from "three";
import { encodeFinish, finishOf, kPlainFinish } from "../model/finish";
import type { Pose, Scene } from "../protocol/messages";
import { makeCoarse } from "./coarse_shape";
import { ContactShadows } from "./contact_shadows";
import { EdgeBatch } from "./edge_batch";
import { raycastPart, type PartShape } from "./part_shape";
import { makePartMaterial, setRoomLight } from "./room_light";

/** Beyond this many vertices of edges a scene is drawn without. */
const kMostEdgeTriangles = 900_000;
const kGhostOpacity = 0.16;

export interface PartLook {
  isHidden: boolean;
  isGhost: boolean;
  isMarked: boolean;
  /** Mixed into the part's colour by `amount`, 0 to 1. */
  tint: Color | null;
  amount: number;
}

const kPlain: PartLook = { isHidden: false, isGhost: false, isMarked: false, tint: null, amount: 0 };

interface Entry {
  occurrence: number;
  instance: number;
  shape: PartShape;
  matrix: Matrix4;
  look: PartLook;
  /** By encodeFinish(). */
  finish: number;
  /** It is small in the picture. */
  isSmall: boolean;
}

export interface PickHit {
  occurrence: number;
  face: number;
  point: Vector3;
  distance: number;
}

const kUnit = new Vector3(1, 1, 1);
const position = new Vector3();
const turn = new Quaternion();
const middle = new Vector3();

export function toMatrix(pose: Pose, out: Matrix4): Matrix4 {
  position.set(...pose.p);
  turn.set(pose.q[1], pose.q[2], pose.q[3], pose.q[0]);
  return out.compose(position, turn, kUnit);
}

/** A part of a smaller diameter than this is drawn coarsely, and without edges [px]; once it is, until it is larger than
 `kLarge`. Choices, made by eye on the picture of 582 parts: with 28 px its screws had lost their outlines. */
const kSmall = 18;
const kLarge = 22;

function makeBatch(shapes: readonly PartShape[], material: MeshStandardMaterial, coarse: readonly BufferGeometry[] = []): BatchedMesh {
  const distinct = [...new Set(shapes)];
  const more = (count: (g: BufferGeometry) => number) => coarse.reduce((n, g) => n + count(g), 0);
  const vertices = distinct.reduce((n, s) => n + s.positions.length / 3, 0) + more((g) => g.getAttribute("position").count);
  const indices = distinct.reduce((n, s) => n + s.index.length, 0) + more((g) => g.index!.count);
  const batch = new BatchedMesh(shapes.length, vertices, indices, material);
  const ids = new Map(distinct.map((shape) => [shape, batch.addGeometry(shape.geometry)]));
  for (const shape of shapes) {
    batch.addInstance(ids.get(shape)!);
  }
  batch.frustumCulled = false;
  return batch;
}

export class Parts {
  readonly root = new Group();
  readonly entries: readonly Entry[];
  private readonly byOccurrence = new Map<number, Entry>();
  private readonly solid: BatchedMesh;
  private readonly geometries = new Map<PartShape, { fine: number; coarse: number }>();
  private ghost: BatchedMesh | null = null;
  private readonly material = makePartMaterial();
  private readonly ghostMaterial = new MeshStandardMaterial({
    vertexColors: true,
    roughness: 0.6,
    transparent: true,
    opacity: kGhostOpacity,
    depthWrite: false,
  });
  readonly edges: EdgeBatch | null;
  private readonly shadows: ContactShadows;

  constructor(shapes: ReadonlyMap<number, PartShape>) {
    this.entries = [...shapes].map(([occurrence, shape], instance) => ({
      occurrence,
      instance,
      shape,
      matrix: new Matrix4(),
      look: kPlain,
      finish: encodeFinish(kPlainFinish),
      isSmall: false,
    }));
    for (const entry of this.entries) {
      this.byOccurrence.set(entry.occurrence, entry);
    }
    const all = this.entries.map((e) => e.shape);
    const coarse = new Map([...new Set(all)].map((shape) => [shape, makeCoarse(shape)] as const));
    const made = [...coarse.values()].filter((each) => each !== null);
    this.solid = makeBatch(all, this.material, made);
    for (const [shape, geometry] of coarse) {
      const fine = this.solid.getGeometryIdAt(all.indexOf(shape));
      this.geometries.set(shape, { fine, coarse: geometry === null ? fine : this.solid.addGeometry(geometry) });
    }
    made.forEach((each) => each.dispose());
    this.solid.sortObjects = false;
    this.solid.castShadow = this.solid.receiveShadow = true;
    this.shadows = new ContactShadows(this.entries.length);
    this.root.add(this.solid, this.shadows.object);
    const triangles = [...new Set(all)].reduce((n, s) => n + s.index.length / 3, 0);
    this.edges = triangles <= kMostEdgeTriangles ? new EdgeBatch(all) : null;
    if (this.edges !== null) {
      this.root.add(this.edges.object);
    }
    for (const entry of this.entries) {
      this.apply(entry);
    }
  }

  /** Draws what is small in a picture coarsely, and without edges.
   @param pixels  Size in the picture of what is a metre large and so far from the eye [m]; null: all is drawn finely. */
  fitDetail(eye: Vector3, pixels: ((distance: number) => number) | null): void {
    let hasChanged = false;
    for (const entry of this.entries) {
      const { center, radius } = entry.shape.sphere;
      const distance = middle.copy(center).applyMatrix4(entry.matrix).distanceTo(eye);
      const size = pixels === null ? Infinity : 2 * radius * pixels(distance);
      const isSmall = !entry.look.isMarked && size < (entry.isSmall ? kLarge : kSmall);
      if (isSmall !== entry.isSmall) {
        const { fine, coarse } = this.geometries.get(entry.shape)!;
        this.solid.setGeometryIdAt(entry.instance, isSmall ? coarse : fine);
        entry.isSmall = isSmall;
        hasChanged = true;
      }
    }
    if (hasChanged) {
      this.edges?.draw((instance) => !this.entries[instance]!.isSmall);
    }
  }

  shapeOf(occurrence: number): PartShape | null {
    return this.byOccurrence.get(occurrence)?.shape ?? null;
  }

  matrixOf(occurrence: number): Matrix4 | null {
    return this.byOccurrence.get(occurrence)?.matrix ?? null;
  }

  /** Takes materials and the table's height from a scene. */
  setScene({ occurrences, table_z_m: table }: Scene): void {
    this.shadows.setTable(table);
    for (const { id, material } of occurrences) {
      const entry = this.byOccurrence.get(id);
      if (entry !== undefined) {
        entry.finish = encodeFinish(finishOf(material));
        this.apply(entry);
      }
    }
  }

  setPose(occurrence: number, pose: Pose): void {
    const entry = this.byOccurrence.get(occurrence);
    if (entry === undefined) {
      return;
    }
    toMatrix(pose, entry.matrix);
    this.solid.setMatrixAt(entry.instance, entry.matrix);
    this.ghost?.setMatrixAt(entry.instance, entry.matrix);
    this.setEdges(entry);
    this.setShadow(entry);
  }

  /** Draws a part as its shape is by now. */
  reshape(occurrence: number): void {
    const entry = this.byOccurrence.get(occurrence);
    if (entry !== undefined) {
      this.solid.setGeometryAt(this.geometries.get(entry.shape)!.fine, entry.shape.geometry);
      this.ghost?.setGeometryAt(this.ghost.getGeometryIdAt(entry.instance), entry.shape.geometry);
      this.edges?.reshape(entry.instance, entry.shape.edges);
    }
  }

  setLook(occurrence: number, look: PartLook): void {
    const entry = this.byOccurrence.get(occurrence);
    if (entry !== undefined) {
      entry.look = look;
      this.apply(entry);
    }
  }

  /** @param hasRoom  Metals reflect a room. */
  setDrawn(hasEdges: boolean, hasRoom: boolean): void {
    setRoomLight(this.material, hasRoom);
    if (this.edges !== null) {
      this.edges.object.visible = hasEdges;
    }
  }

  setClipping(planes: Plane[]): void {
    for (const material of [this.material, this.ghostMaterial, this.edges?.object.material]) {
      if (material) {
        material.clippingPlanes = planes;
        material.needsUpdate = true;
      }
    }
    this.material.side = planes.length > 0 ? DoubleSide : FrontSide;
    this.material.clipShadows = planes.length > 0;
  }

  /** The nearest visible part that the ray meets, on the kept side of the planes. */
  raycast(ray: Ray, planes: readonly Plane[] = []): PickHit | null {
    let best: PickHit | null = null;
    for (const entry of this.entries) {
      if (entry.look.isHidden) {
        continue;
      }
      const hit = raycastPart(entry.shape, entry.matrix, ray);
      if (hit === null || (best !== null && hit.distance >= best.distance)) {
        continue;
      }
      const point = hit.point.clone().applyMatrix4(entry.matrix);
      if (planes.every((plane) => plane.distanceToPoint(point) >= 0)) {
        best = { occurrence: entry.occurrence, face: hit.face, point, distance: hit.distance };
      }
    }
    return best;
  }

  /** In W: corners of the boxes of what is not hidden, or of the given ones. */
  corners(only?: ReadonlySet<number>): Vector3[] {
    const corners: Vector3[] = [];
    for (const entry of this.entries) {
      if (only === undefined ? entry.look.isHidden : !only.has(entry.occurrence)) {
        continue;
      }
      const { min, max } = entry.shape.box;
      for (const x of [min.x, max.x]) {
        for (const y of [min.y, max.y]) {
          corners.push(...[min.z, max.z].map((z) => new Vector3(x, y, z).applyMatrix4(entry.matrix)));
        }
      }
    }
    return corners;
  }

  dispose(): void {
    this.solid.dispose();
    this.ghost?.dispose();
    this.edges?.dispose();
    this.shadows.dispose();
    this.material.dispose();
    this.ghostMaterial.dispose();
    for (const shape of new Set(this.entries.map((e) => e.shape))) {
      shape.dispose();
    }
  }

  private apply(entry: Entry): void {
    const { look, instance } = entry;
    if (look.isGhost && this.ghost === null) {
      this.ghost = this.makeGhosts();
    }
    const color = (entry.shape.color ?? new Color(1, 1, 1)).clone();
    if (look.tint !== null) {
      color.lerp(look.tint, look.amount);
    }
    this.solid.setColorAt(instance, new Vector4(color.r, color.g, color.b, entry.finish));
    this.solid.setVisibleAt(instance, !look.isHidden && !look.isGhost);
    this.ghost?.setColorAt(instance, color);
    this.ghost?.setVisibleAt(instance, !look.isHidden && look.isGhost);
    this.setEdges(entry);
    this.setShadow(entry);
  }

  private setShadow({ instance, shape, matrix, look }: Entry): void {
    this.shadows.place(instance, shape.box, matrix, !look.isHidden && !look.isGhost);
  }

  private setEdges(entry: Entry): void {
    const { look } = entry;
    const strength = look.isHidden ? 0 : look.isGhost ? 0.35 : 0.85;
    this.edges?.setPose(entry.instance, entry.matrix, strength, look.isMarked);
  }

  private makeGhosts(): BatchedMesh {
    const batch = makeBatch(this.entries.map((e) => e.shape), this.ghostMaterial);
    batch.renderOrder = 2;
    for (const entry of this.entries) {
      batch.setMatrixAt(entry.instance, entry.matrix);
      batch.setVisibleAt(entry.instance, false);
    }
    this.root.add(batch);
    return batch;
  }
}
