import { describe, expect, it } from "vitest";
import { distance, type Pose, type Vec3 } from "../src/model/math";
import { leadersOf, makeStore, togetherWith, withLeader } from "../src/model/store";
import { nearestPlace, placeOnTable, type Place } from "../src/view3d/hand_places";
import { posesInHand } from "../src/view3d/held_members";
import { toyScene } from "./toy_recording";

/** An eye that looks along y from far away: parallel, a millimetre a pixel. */
const eye = {
  rayTo: (p: Vec3) => ({ from: [p[0], -10, p[2]] as Vec3, along: [0, 1, 0] as Vec3 }),
  metresPerPixel: () => 1e-3,
};
const kUpright: Pose = { p: [0, 0, 0], q: [1, 0, 0, 0] };

describe("X1 places of a held part", () => {
  const inProduct: Place = { goal: { p: [0, 0, 0.5], q: [1, 0, 0, 0] }, way: { p: [0, 0, 0.5], d: [0, 0, 1], low: -0.03, high: 0.1 } };
  const X_HB: Pose = { p: [0, 0, -0.01], q: [1, 0, 0, 0] };
  const told = { target: [2], goal: { p: [0.3, 0.1, 0], q: [1, 0, 0, 0] }, way_in: [0, 0, -1], distance_m: 0.02, is_there: false } as const;
  const onTable = placeOnTable(told, X_HB, 0.02);

  it("are those of the hand, with a way in from above", () => {
    expect(distance(onTable.goal.p, [0.3, 0.1, 0.01])).toBeLessThan(1e-12);
    expect(onTable.way!.d[2]).toBe(1);
    expect(onTable.way!.high).toBeCloseTo(0.03);
  });

  it("are chosen by the pointer: the one on the table where it is near, else the product", () => {
    const places = [inProduct, onTable];
    expect(nearestPlace(places, [0.33, 0, 0.05], eye)).toBe(onTable);
    expect(nearestPlace(places, [0.02, 0, 0.55], eye)).toBe(inProduct);
    expect(nearestPlace(places, [0.6, 0, 0.3], eye)).toBe(inProduct);
  });
});

describe("X1 parts that are put together on the table", () => {
  it("are known by the part that leads them, until they come apart", () => {
    const two = withLeader(withLeader(new Map(), 1, 1), 2, 1);
    expect(togetherWith(two, 2).sort()).toEqual([1, 2]);
    expect(togetherWith(two, 0)).toEqual([0]);
    expect(togetherWith(withLeader(two, 2, undefined), 2)).toEqual([2]);
    expect(leadersOf(toyScene).size).toBe(0);
  });

  it("are held together and drawn as they belong to one another", () => {
    const store = makeStore();
    store.live.scene.value = toyScene;
    store.live.leaders.value = new Map([[1, 1], [2, 1]]);
    store.live.placements.value = new Map([[1, "held"], [2, "held"]]);
    store.live.held.value = [{ hand: 0, occurrence: 1, state: "free", mate: null }];
    expect([...store.heldBy.value.keys()].sort()).toEqual([1, 2]);
    const [a, b] = [toyScene.occurrences[1]!.goal, toyScene.occurrences[2]!.goal];
    const poses = new Map(posesInHand(store, 1, { ...kUpright, q: a.q }));
    const drawn = b.p.map((v, k) => v - a.p[k]!) as unknown as Vec3;
    expect(distance(poses.get(2)!.p, drawn)).toBeLessThan(1e-9);
  });
});
