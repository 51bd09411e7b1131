/** The mesh of one part, in its own frame B: for drawing, for its edges and for picking. */

import { BufferAttribute, BufferGeometry, Color, Matrix4, Ray, Vector3, type Intersection, DoubleSide } from "three";
import { MeshBVH } from "three-mesh-bvh";
import { findFaceEdges } from "./edges";

export interface PartHit {
  /** In B. */
  point: Vector3;
  distance: number;
  face: number;
}

export class PartShape {
  readonly box;
  readonly sphere;
  /** The part as in the file; another one where this one is deformed. */
  drawn: PartShape = this;
  private bvh: MeshBVH | null = null;
  private edgeLines: Float32Array | null = null;

  /** @param geometry  Indexed, with position, normal, color.
   @param faceIds  Of each vertex.
   @param color  Of the whole part, where it has one; null: its vertices have theirs. */
  constructor(
    readonly geometry: BufferGeometry,
    readonly faceIds: Float32Array,
    readonly color: Color | null,
  ) {
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
    this.box = geometry.boundingBox!;
    this.sphere = geometry.boundingSphere!;
  }

  get index(): ArrayLike<number> {
    return this.geometry.index!.array;
  }

  get positions(): Float32Array {
    return this.geometry.getAttribute("position").array as Float32Array;
  }

  /** Segments between faces: two points with the normals of both sides each. */
  get edges(): Float32Array {
    this.edgeLines ??= findFaceEdges(this.positions, this.index, this.faceIds);
    return this.edgeLines;
  }

  /** Its positions and edges are others from now on. */
  changeForm(): void {
    this.geometry.getAttribute("position").needsUpdate = true;
    this.geometry.computeBoundingBox();
    this.geometry.computeBoundingSphere();
    this.bvh = null;
  }

  /** @param ray  In B. */
  raycast(ray: Ray): PartHit | null {
    // Built when it is first asked for: most parts are never pointed at.
    this.bvh ??= new MeshBVH(this.geometry, { indirect: true });
    const hit: Intersection | null = this.bvh.raycastFirst(ray, DoubleSide);
    if (hit === null || hit === undefined || hit.faceIndex === null || hit.faceIndex === undefined) {
      return null;
    }
    const vertex = this.index[3 * hit.faceIndex] ?? 0;
    return { point: hit.point, distance: hit.distance, face: Math.round(this.faceIds[vertex] ?? 0) };
  }

  /** The triangles of one face as a mesh of its own, which shares nothing with the part. */
  faceGeometry(face: number): BufferGeometry {
    const corners: number[] = [];
    const { index, positions } = this;
    for (let k = 0; k < index.length; k += 3) {
      if (Math.round(this.faceIds[index[k] ?? 0] ?? -1) === face) {
        for (let corner = k; corner < k + 3; corner++) {
          const at = 3 * (index[corner] ?? 0);
          corners.push(positions[at] ?? 0, positions[at + 1] ?? 0, positions[at + 2] ?? 0);
        }
      }
    }
    return new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
  }

  dispose(): void {
    this.geometry.dispose();
    if (this.drawn !== this) {
      this.drawn.dispose();
    }
  }
}

/** One part of several primitives: joined, each with its colour at its vertices. */
export function joinPrimitives(primitives: readonly { geometry: BufferGeometry; color: Color }[]): PartShape {
  const count = (g: BufferGeometry) => g.getAttribute("position").count;
  const vertices = primitives.reduce((n, p) => n + count(p.geometry), 0);
  const triangles = primitives.reduce((n, p) => n + (p.geometry.index?.count ?? count(p.geometry)), 0);
  const positions = new Float32Array(3 * vertices);
  const normals = new Float32Array(3 * vertices);
  const colors = new Uint8Array(3 * vertices).fill(255);
  const faceIds = new Float32Array(vertices);
  const index = new Uint32Array(triangles);
  const first = primitives[0]?.color ?? new Color(0.6, 0.6, 0.6);
  const isPlain = primitives.every((p) => p.color.equals(first));
  let vertexAt = 0;
  let indexAt = 0;
  for (const { geometry, color } of primitives) {
    const n = count(geometry);
    positions.set(geometry.getAttribute("position").array, 3 * vertexAt);
    if (geometry.getAttribute("normal") === undefined) {
      geometry.computeVertexNormals();
    }
    normals.set(geometry.getAttribute("normal").array, 3 * vertexAt);
    faceIds.set(geometry.getAttribute("_face_id")?.array ?? new Float32Array(n), vertexAt);
    if (!isPlain) {
      for (let k = 0; k < n; k++) {
        colors.set([color.r * 255, color.g * 255, color.b * 255], 3 * (vertexAt + k));
      }
    }
    const source = geometry.index?.array ?? Uint32Array.from({ length: n }, (_, k) => k);
    for (let k = 0; k < source.length; k++) {
      index[indexAt + k] = (source[k] ?? 0) + vertexAt;
    }
    vertexAt += n;
    indexAt += source.length;
  }
  const joined = new BufferGeometry();
  joined.setAttribute("position", new BufferAttribute(positions, 3));
  joined.setAttribute("normal", new BufferAttribute(normals, 3));
  joined.setAttribute("color", new BufferAttribute(colors, 3, true));
  joined.setIndex(new BufferAttribute(index, 1));
  return new PartShape(joined, faceIds, isPlain ? first : null);
}

const toLocal = new Matrix4();
const localRay = new Ray();
const centre = new Vector3();

/** Points at a part that stands at `matrix`; the distance is in W. */
export function raycastPart(shape: PartShape, matrix: Matrix4, ray: Ray): PartHit | null {
  centre.copy(shape.sphere.center).applyMatrix4(matrix);
  if (ray.distanceSqToPoint(centre) > shape.sphere.radius * shape.sphere.radius) {
    return null;
  }
  localRay.copy(ray).applyMatrix4(toLocal.copy(matrix).invert());
  return shape.raycast(localRay);
}
