/** Equal parts that lie beside one another on the table, as bins of a store would hold them: one label says what they are. */

import { add, distance, scale, type Vec3 } from "./math";

/** A part where it lies now. */
export interface LyingPart {
  id: number;
  /** Parts of one shape have the same. */
  part: number;
  name: string;
  /** The middle of it, in W [m]. */
  p_W: Vec3;
  /** Half of its extent [m]. */
  radius: number;
}

export interface PartGroup {
  name: string;
  ids: readonly number[];
  /** The middle of all of them, in W [m]. */
  p_W: Vec3;
}

/** Parts whose middles are nearer than so many of their radii lie beside one another: a choice. */
const kBeside = 5;

/** Fewer need no label of their own: a choice. */
const kLeastMembers = 3;

/** "screw M5 12" and "screw M5 3" are both a "screw M5". */
export function commonName(names: readonly string[]): string {
  const [first = ""] = names;
  const bare = first.replace(/[\s._#:-]*\d+$/, "");
  return bare !== "" && names.every((name) => name.startsWith(bare)) ? bare : first;
}

/** Largest groups first. */
export function groupLying(parts: readonly LyingPart[]): PartGroup[] {
  const ofPart = new Map<number, LyingPart[]>();
  for (const each of parts) {
    ofPart.set(each.part, [...(ofPart.get(each.part) ?? []), each]);
  }
  return [...ofPart.values()]
    .flatMap(splitByPlace)
    .filter((group) => group.length >= kLeastMembers)
    .map((group) => ({
      name: commonName(group.map(({ name }) => name)),
      ids: group.map(({ id }) => id),
      p_W: scale(group.map(({ p_W }) => p_W).reduce(add), 1 / group.length),
    }))
    .sort((a, b) => b.ids.length - a.ids.length);
}

/** Sets of parts of which each lies beside another one of its set. */
function splitByPlace(parts: readonly LyingPart[]): LyingPart[][] {
  const left = new Set(parts);
  const groups: LyingPart[][] = [];
  for (const first of parts) {
    if (!left.delete(first)) {
      continue;
    }
    const group = [first];
    for (let at = 0; at < group.length; at++) {
      const from = group[at]!;
      for (const other of [...left].filter(({ p_W }) => distance(p_W, from.p_W) < kBeside * from.radius)) {
        left.delete(other);
        group.push(other);
      }
    }
    groups.push(group);
  }
  return groups;
}

export interface PlacedLabel {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** Which labels are shown, so that none covers another: those that come first go first. */
export function withoutOverlaps(labels: readonly PlacedLabel[]): boolean[] {
  const shown: PlacedLabel[] = [];
  return labels.map((label) => {
    const covers = (other: PlacedLabel) =>
      Math.abs(label.x - other.x) < (label.width + other.width) / 2 && Math.abs(label.y - other.y) < (label.height + other.height) / 2;
    const isFree = !shown.some(covers);
    if (isFree) {
      shown.push(label);
    }
    return isFree;
  });
}
