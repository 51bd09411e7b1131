import type { Occurrence } from "../src/protocol/messages";

export function makePart(id: number, name: string, ofPart: number, more: Partial<Occurrence> = {}): Occurrence {
  const pose = { p: [0, 0, 0], q: [1, 0, 0, 0] } as const;
  return {
    id,
    name,
    path: name,
    parent: 0,
    part: ofPart,
    color: "#808080",
    placement: "loose",
    start: pose,
    goal: pose,
    mass_kg: 1,
    material: "Steel",
    p_BoBcm_m: [0, 0, 0],
    is_base: false,
    ...more,
  };
}
