/** Edges as a drawing shows them: where two faces of the CAD model meet at an angle. */

/** Below this angle faces run into one another smoothly [cosine of 10 deg]. */
const kSmooth = Math.cos((10 * Math.PI) / 180);
/** Points nearer than this are one [m]. */
const kWeld = 1e-7;
/** Of an edge: two points and the normals of both sides. */
export const kEdgeFloats = 12;

interface Side {
  from: number;
  to: number;
  face: number;
  normal: [number, number, number];
}

function weld(positions: Float32Array): Uint32Array {
  const known = new Map<string, number>();
  const ids = new Uint32Array(positions.length / 3);
  for (let v = 0; v < ids.length; v++) {
    const key = [0, 1, 2].map((k) => Math.round((positions[3 * v + k] ?? 0) / kWeld)).join();
    let id = known.get(key);
    if (id === undefined) {
      id = v;
      known.set(key, v);
    }
    ids[v] = id;
  }
  return ids;
}

function triangleNormal(p: Float32Array, a: number, b: number, c: number): [number, number, number] {
  const at = (v: number, k: number) => p[3 * v + k] ?? 0;
  const u = [0, 1, 2].map((k) => at(b, k) - at(a, k)) as [number, number, number];
  const w = [0, 1, 2].map((k) => at(c, k) - at(a, k)) as [number, number, number];
  const n: [number, number, number] = [
    u[1] * w[2] - u[2] * w[1],
    u[2] * w[0] - u[0] * w[2],
    u[0] * w[1] - u[1] * w[0],
  ];
  const length = Math.hypot(...n) || 1;
  return [n[0] / length, n[1] / length, n[2] / length];
}

function isDrawn(a: Side, b: Side | undefined): boolean {
  if (b === undefined) {
    return true;
  }
  const cosine = a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1] + a.normal[2] * b.normal[2];
  return a.face !== b.face && cosine < kSmooth;
}

export function findFaceEdges(
  positions: Float32Array,
  index: ArrayLike<number>,
  faceIds: Float32Array,
): Float32Array {
  const ids = weld(positions);
  const vertexCount = ids.length;
  const open = new Map<number, Side>();
  const out: number[] = [];
  const draw = (a: Side, b: Side | undefined): void => {
    for (const v of [a.from, a.to]) {
      out.push(positions[3 * v] ?? 0, positions[3 * v + 1] ?? 0, positions[3 * v + 2] ?? 0);
    }
    out.push(...a.normal, ...(b ?? a).normal);
  };
  for (let k = 0; k < index.length; k += 3) {
    const corners = [index[k] ?? 0, index[k + 1] ?? 0, index[k + 2] ?? 0] as const;
    const normal = triangleNormal(positions, ...corners);
    const face = faceIds[corners[0]] ?? 0;
    for (let e = 0; e < 3; e++) {
      const from = ids[corners[e] ?? 0] ?? 0;
      const to = ids[corners[(e + 1) % 3] ?? 0] ?? 0;
      const key = Math.min(from, to) * vertexCount + Math.max(from, to);
      const side: Side = { from, to, face, normal };
      const other = open.get(key);
      if (other === undefined) {
        open.set(key, side);
        continue;
      }
      open.delete(key);
      if (isDrawn(other, side)) {
        draw(other, side);
      }
    }
  }
  for (const side of open.values()) {
    draw(side, undefined);
  }
  return new Float32Array(out);
}
