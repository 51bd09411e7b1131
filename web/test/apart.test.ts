import { describe, expect, it } from "vitest";
import { takenOut, takingApart } from "../src/model/apart";
import type { Step } from "../src/protocol/messages";

const step = (kind: Step["kind"], occurrence: number, members: number[] = []): Step => ({
  kind,
  occurrence,
  members,
  way_in: [0, 0, -1],
  distance_m: 0.1,
});
const steps = [step("base", 0), step("insert", 1), step("park", 1), step("insert", 2, [2, 3]), step("insert", 4)];

describe("taking apart", () => {
  it("is the order of assembly backwards, without what only prepares", () => {
    expect(takingApart(steps).map((s) => s.occurrence)).toEqual([4, 2, 1]);
  });

  it("takes subassemblies out as one", () => {
    expect([...takenOut(takingApart(steps), 2)].sort()).toEqual([2, 3, 4]);
    expect(takenOut(takingApart(steps), 0).size).toBe(0);
    expect(takenOut(takingApart(steps), 9).size).toBe(4);
  });
});
