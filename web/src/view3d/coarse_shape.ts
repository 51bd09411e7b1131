/** A coarse mesh of a part, for where it is small in the picture: corners that lie in one cell of a grid become one. */

import { BufferAttribute, BufferGeometry, Vector3 } from "three";
import type { PartShape } from "./part_shape";

/** Cells along the longest side of the part's box: a choice, with which a cell of a small part is three pixels. */
const kCells = 6;
/** Coarse meshes that save less than this share of the triangles are not used: a choice. */
const kLeastSaved = 0.5;

/** Which of six directions a normal is nearest to: corners of a cell stay apart by it, so that edges stay sharp. */
function facing(x: number, y: number, z: number): number {
  const [ax, ay, az] = [Math.abs(x), Math.abs(y), Math.abs(z)];
  const axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
  const along = axis === 0 ? x : axis === 1 ? y : z;
  return 2 * axis + (along < 0 ? 1 : 0);
}

/** Makes the coarse mesh with the attributes of the fine one; null where it would save too little. */
export function makeCoarse({ geometry, positions, index, box }: PartShape): BufferGeometry | null {
  const normals = geometry.getAttribute("normal").array;
  const colors = geometry.getAttribute("color").array;
  const size = box.getSize(new Vector3());
  const cell = Math.max(size.x, size.y, size.z, 1e-9) / kCells;
  const cellOf = new Int32Array(positions.length / 3);
  const cornerOf = new Int32Array(positions.length / 3);
  const corners = new Map<number, number>();
  const sums: number[] = []; // position, normal, count, first corner
  for (let k = 0; k < cellOf.length; k++) {
    const at = 3 * k;
    const [x, y, z] = [positions[at] ?? 0, positions[at + 1] ?? 0, positions[at + 2] ?? 0];
    const [nx, ny, nz] = [normals[at] ?? 0, normals[at + 1] ?? 0, normals[at + 2] ?? 0];
    const along = (value: number, low: number) => Math.min(kCells - 1, Math.floor((value - low) / cell));
    const place = (along(x, box.min.x) * kCells + along(y, box.min.y)) * kCells + along(z, box.min.z);
    const key = 6 * place + facing(nx, ny, nz);
    const corner = corners.get(key) ?? corners.size;
    if (corner === corners.size) {
      corners.set(key, corner);
      sums.push(0, 0, 0, 0, 0, 0, 0, k);
    }
    [x, y, z, nx, ny, nz, 1].forEach((value, i) => (sums[8 * corner + i] = (sums[8 * corner + i] ?? 0) + value));
    cellOf[k] = place;
    cornerOf[k] = corner;
  }
  const kept: number[] = [];
  for (let k = 0; k < index.length; k += 3) {
    const [a, b, c] = [index[k] ?? 0, index[k + 1] ?? 0, index[k + 2] ?? 0];
    if (cellOf[a] !== cellOf[b] && cellOf[b] !== cellOf[c] && cellOf[c] !== cellOf[a]) {
      kept.push(cornerOf[a] ?? 0, cornerOf[b] ?? 0, cornerOf[c] ?? 0);
    }
  }
  if (kept.length === 0 || kept.length > (1 - kLeastSaved) * index.length) {
    return null;
  }
  return fill(sums, kept, colors);
}

function fill(sums: readonly number[], index: readonly number[], colors: ArrayLike<number>): BufferGeometry {
  const count = sums.length / 8;
  const positions = new Float32Array(3 * count);
  const normals = new Float32Array(3 * count);
  const ownColors = new Uint8Array(3 * count);
  const normal = new Vector3();
  for (let corner = 0; corner < count; corner++) {
    const sum = sums.slice(8 * corner, 8 * corner + 8);
    const [first, many] = [3 * (sum[7] ?? 0), sum[6] ?? 1];
    positions.set([0, 1, 2].map((i) => (sum[i] ?? 0) / many), 3 * corner);
    normal.fromArray(sum, 3).normalize().toArray(normals, 3 * corner);
    ownColors.set([0, 1, 2].map((i) => colors[first + i] ?? 255), 3 * corner);
  }
  const coarse = new BufferGeometry();
  coarse.setAttribute("position", new BufferAttribute(positions, 3));
  coarse.setAttribute("normal", new BufferAttribute(normals, 3));
  coarse.setAttribute("color", new BufferAttribute(ownColors, 3, true));
  coarse.setIndex(new BufferAttribute(Uint32Array.from(index), 1));
  return coarse;
}
