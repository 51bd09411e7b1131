/** The mates that a card of a fit can be about, and which of them it is about. */

import type { Mate } from "../protocol/messages";

/** The same before and after a change of the product. */
export function mateKey(mate: Mate): string {
  return mate.key || `${mate.id}`;
}

/** "H7/g6" and the like; whether the standard has it is for the server to say. */
export function isFitCode(text: string): boolean {
  return /^[A-Za-z]{1,2}\d{1,2}\/[A-Za-z]{1,2}\d{1,2}$/.test(text.trim());
}

/** Shafts in holes and tongues in slots. */
export function canHaveFit(mate: Mate): boolean {
  return mate.kind === "axis_hole" || mate.kind === "prismatic";
}

/** Those of the parts that can have a fit, in the order of the product: of one part all, of two those between them. */
export function matesWithFit(mates: readonly Mate[], parts: readonly number[]): Mate[] {
  const isOf = (mate: Mate) =>
    parts.length === 2
      ? parts.includes(mate.a) && parts.includes(mate.b)
      : parts.length === 1 && (mate.a === parts[0] || mate.b === parts[0]);
  return mates.filter((mate) => isOf(mate) && (canHaveFit(mate) || mate.fit !== null));
}

/** Where nobody has chosen one yet: the mate that guides, else the tightest, else any. */
export function firstMate(mates: readonly Mate[], guiding: number | null): Mate | null {
  const tightness = (mate: Mate) => mate.fit?.clearance_actual_um ?? Infinity;
  const byTightness = mates.filter((mate) => mate.fit !== null).sort((a, b) => tightness(a) - tightness(b));
  return byTightness.find((mate) => mate.id === guiding) ?? byTightness[0] ?? mates[0] ?? null;
}
