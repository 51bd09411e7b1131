/** Parts that give: each of them has a mesh of its own, which follows how far it is deformed. */

import { BufferAttribute, BufferGeometry } from "three";
import { deformPoint } from "../model/deform";
import type { FrameStore } from "../protocol/frame_store";
import type { Deformable, Scene, Vec3 } from "../protocol/messages";
import { kEdgeFloats } from "./edges";
import { PartShape } from "./part_shape";
import type { Parts } from "./parts";

/** An edge that bends by more than this share of the amount is split: a choice, some ten pieces of an arm. */
const kStraight = 0.01;
/** The amount that tells where edges are split [m]; bending is linear in it. */
const kProbe = 1e-3;
/** Halvings of an edge of a mesh, at most: a choice. */
const kMostSplits = 10;

interface Form {
  index: number;
  form: Deformable;
}

function readPoint(from: ArrayLike<number>, at: number): Vec3 {
  return [from[at] ?? 0, from[at + 1] ?? 0, from[at + 2] ?? 0];
}

function halfway(a: Vec3, b: Vec3): Vec3 {
  return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2];
}

/** How far the middle of an edge leaves its line when the part is deformed [m]. */
function bowOf(forms: readonly Form[], a: Vec3, b: Vec3): number {
  const moved = (p: Vec3) => forms.reduce((q, { form }) => deformPoint(form, kProbe, q), p);
  const straight = halfway(moved(a), moved(b));
  const bent = moved(halfway(a, b));
  return Math.hypot(bent[0] - straight[0], bent[1] - straight[1], bent[2] - straight[2]);
}

/** A mesh with a copy of everything, whose edges are split where arms bend. An edge is split in its middle by itself,
 whatever triangle it is of, so no cracks open. */
export function splitForBending(shape: PartShape, forms: readonly Form[]): PartShape {
  const { geometry, positions, index, faceIds, color } = shape;
  const bends = forms.filter(({ form }) => form.kind === "bend" || form.kind === "flare");
  const values = (name: string): number[] => [...geometry.getAttribute(name).array];
  const points = [...positions];
  const normals = values("normal");
  const colors = values("color");
  const faces = [...faceIds];
  const middles = new Map<string, number>();
  const middleOf = (a: number, b: number): number => {
    const key = a < b ? `${a},${b}` : `${b},${a}`;
    const known = middles.get(key);
    if (known !== undefined) {
      return known;
    }
    const made = faces.length;
    for (const list of [points, normals, colors]) {
      list.push(...halfway(readPoint(list, 3 * a), readPoint(list, 3 * b)));
    }
    faces.push(faces[a] ?? 0);
    middles.set(key, made);
    return made;
  };
  const triangles: number[] = [];
  const open: [number, number, number, number][] = [];
  for (let k = 0; k < index.length; k += 3) {
    open.push([index[k] ?? 0, index[k + 1] ?? 0, index[k + 2] ?? 0, 0]);
  }
  for (let next = open.pop(); next !== undefined; next = open.pop()) {
    const [a, b, c, depth] = next;
    const corners = [a, b, c] as const;
    const bows = corners.map((v, k) => bowOf(bends, readPoint(points, 3 * v), readPoint(points, 3 * corners[(k + 1) % 3]!)));
    const most = Math.max(...bows);
    if (bends.length === 0 || depth >= 3 * kMostSplits || most <= kStraight * kProbe) {
      triangles.push(a, b, c);
      continue;
    }
    const from = bows.indexOf(most);
    const [u, v, w] = [corners[from]!, corners[(from + 1) % 3]!, corners[(from + 2) % 3]!];
    const middle = middleOf(u, v);
    open.push([u, middle, w, depth + 1], [middle, v, w, depth + 1]);
  }
  const split = new BufferGeometry();
  split.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  split.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
  split.setAttribute("color", new BufferAttribute(new Uint8Array(colors), 3, true));
  split.setIndex(new BufferAttribute(new Uint32Array(triangles), 1));
  return new PartShape(split, new Float32Array(faces), color);
}

/** One part with a mesh of its own. */
class DeformedPart {
  readonly shape: PartShape;
  private readonly rest: Float32Array;
  private restEdges: Float32Array | null = null;
  private amounts: number[] = [];

  constructor(
    shape: PartShape,
    private readonly forms: readonly Form[],
  ) {
    this.shape = splitForBending(shape, forms);
    this.shape.drawn = shape;
    this.rest = this.shape.positions.slice();
  }

  /** @return Whether it is another form than before. */
  update(frames: FrameStore): boolean {
    const amounts = this.forms.map(({ index }) => frames.readDeformation(index));
    if (amounts.every((amount, k) => amount === (this.amounts[k] ?? 0))) {
      return false;
    }
    this.amounts = amounts;
    this.restEdges ??= this.shape.edges.slice();
    this.move(this.rest, this.shape.positions, 3, 1);
    this.move(this.restEdges, this.shape.edges, kEdgeFloats, 2);
    this.shape.changeForm();
    return true;
  }

  /** Moves the first points of each item. */
  private move(from: Float32Array, to: Float32Array, stride: number, count: number): void {
    for (let at = 0; at < from.length; at += stride) {
      for (let k = at; k < at + 3 * count; k += 3) {
        const moved = this.forms.reduce((p, { form }, i) => deformPoint(form, this.amounts[i] ?? 0, p), readPoint(from, k));
        to.set(moved, k);
      }
    }
  }
}

export class DeformedParts {
  /** Shapes by occurrence: what is deformed has one of its own. */
  readonly shapes: ReadonlyMap<number, PartShape>;
  private readonly parts = new Map<number, DeformedPart>();
  private readonly key: string;
  private generation = -1;

  constructor(shapes: ReadonlyMap<number, PartShape>, scene: Scene) {
    this.key = keyOf(scene);
    const forms = new Map<number, Form[]>();
    (scene.deformables ?? []).forEach((form, index) => {
      forms.set(form.occurrence, [...(forms.get(form.occurrence) ?? []), { index, form }]);
    });
    const own = new Map(shapes);
    for (const [occurrence, list] of forms) {
      const shape = shapes.get(occurrence);
      if (shape !== undefined) {
        const part = new DeformedPart(shape, list);
        this.parts.set(occurrence, part);
        own.set(occurrence, part.shape);
      }
    }
    this.shapes = own;
  }

  /** Whether these are the deformed parts of a scene. */
  isOf(scene: Scene): boolean {
    return this.key === keyOf(scene);
  }

  /** Gives each part the form that the frames say. @return Whether one looks different from before. */
  update(frames: FrameStore, drawn: Parts): boolean {
    if (frames.deformationGeneration === this.generation) {
      return false;
    }
    this.generation = frames.deformationGeneration;
    let hasChanged = false;
    for (const [occurrence, part] of this.parts) {
      if (part.update(frames)) {
        drawn.reshape(occurrence);
        hasChanged = true;
      }
    }
    return hasChanged;
  }

  /** Takes all amounts from the frames again. */
  forget(): void {
    this.generation = -1;
  }
}

function keyOf(scene: Scene): string {
  return JSON.stringify(scene.deformables ?? []);
}
