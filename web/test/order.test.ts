import { describe, expect, it } from "vitest";
import { movableSteps, movesOf, placeAt, withMoved } from "../src/model/order";
import type { Step } from "../src/protocol/messages";

const step = (kind: Step["kind"], occurrence: number, members: number[] = []): Step => ({
  kind,
  occurrence,
  members,
  way_in: [0, 0, -1],
  distance_m: 0.1,
});
const steps = [step("insert", 1), step("park", 1), step("base", 0), step("insert", 2, [2, 3]), step("insert", 4)];

describe("an order that is tried out", () => {
  it("has the steps after what is put together by itself", () => {
    expect(movableSteps(steps).map((s) => s.occurrence)).toEqual([2, 4]);
    expect(movableSteps([step("base", 0), step("insert", 5)]).map((s) => s.occurrence)).toEqual([5]);
    expect(movableSteps([])).toEqual([]);
  });

  it("has what moves together as one", () => {
    expect(movesOf(steps).map((move) => [move.occurrence, ...move.members])).toEqual([[2, 3], [4]]);
  });

  it("gets an item at another place, and never beside the list", () => {
    expect(withMoved(["a", "b", "c", "d"], 0, 2)).toEqual(["b", "c", "a", "d"]);
    expect(withMoved(["a", "b", "c", "d"], 3, 1)).toEqual(["a", "d", "b", "c"]);
    expect(withMoved(["a", "b"], 1, 9)).toEqual(["a", "b"]);
    expect(withMoved(["a", "b"], 1, -3)).toEqual(["b", "a"]);
  });

  it("takes the place at which it is dropped", () => {
    const middles = [10, 30, 50, 70];
    expect(placeAt(middles, 0, 5)).toBe(0);
    expect(placeAt(middles, 0, 55)).toBe(2);
    expect(placeAt(middles, 3, 25)).toBe(1);
    expect(placeAt(middles, 2, 52)).toBe(2);
    expect(placeAt(middles, 1, 1000)).toBe(3);
  });
});
