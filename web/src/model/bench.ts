/** What somebody has put on the workbench around the product: for the eye only, the hand meets none of it. */

export const kBenchKinds = ["vise", "chuck", "hammer", "screwdriver", "spanner", "caliper", "tray", "vblock"] as const;
export type BenchKind = (typeof kBenchKinds)[number];

export interface BenchItem {
  kind: BenchKind;
  /** From the middle of the bench [m]. */
  x: number;
  y: number;
  /** About the vertical [rad]. */
  turn: number;
}

/** The bench: its half width and half depth [m]. */
export interface BenchSize {
  x: number;
  y: number;
}

const kLeast: BenchSize = { x: 0.8, y: 0.45 };
/** Of the parts that lie about, before the rim. */
const kRim = 0.28;

/** A bench on which a product within this radius has room. */
export function benchSize(radius: number): BenchSize {
  return { x: Math.max(kLeast.x, radius + 1.6 * kRim), y: Math.max(kLeast.y, radius + kRim) };
}

/** One of each, along the far rim and the sides. */
export function firstItems({ x, y }: BenchSize): BenchItem[] {
  const back = y - 0.13;
  const side = x - 0.17;
  const at = (kind: BenchKind, u: number, v: number, turn = 0): BenchItem => ({ kind, x: u, y: v, turn });
  return [
    at("vise", -side, back - 0.04),
    at("chuck", side, back),
    at("hammer", side, 0.05, 1.3),
    at("screwdriver", side, -0.18, 1.7),
    at("spanner", -side, -0.02, 1.45),
    at("caliper", -side + 0.09, -0.16, 1.6),
    at("tray", 0.2, back),
    at("vblock", -0.18, back),
  ];
}

export function keepOnBench(item: BenchItem, size: BenchSize): BenchItem {
  const clamp = (v: number, most: number) => Math.min(most, Math.max(-most, v));
  return { ...item, x: clamp(item.x, size.x - 0.06), y: clamp(item.y, size.y - 0.06) };
}

export function isItem(value: unknown): value is BenchItem {
  const { kind, x, y, turn } = (value ?? {}) as Partial<BenchItem>;
  return kBenchKinds.includes(kind as BenchKind) && [x, y, turn].every((v) => Number.isFinite(v));
}
