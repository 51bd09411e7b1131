/** Groups of equal parts on the table, and labels that do not cover one another. */

import { describe, expect, it } from "vitest";
import { commonName, groupLying, withoutOverlaps, type LyingPart } from "../src/model/groups";

function lying(id: number, part: number, x: number, name = `screw M5 ${id}`): LyingPart {
  return { id, part, name, p_W: [x, 0, 0], radius: 0.01 };
}

describe("equal parts that lie beside one another", () => {
  it("are one group with their common name, in their middle", () => {
    const [group, ...others] = groupLying([lying(1, 7, 0), lying(2, 7, 0.03), lying(3, 7, 0.06)]);
    expect(others).toEqual([]);
    expect(group).toMatchObject({ name: "screw M5", ids: [1, 2, 3] });
    expect(group!.p_W[0]).toBeCloseTo(0.03);
  });

  it("are two groups where there is a gap, and none of fewer than three", () => {
    const near = [0, 0.03, 0.06].map((x, k) => lying(k, 7, x));
    const far = [1, 1.03, 1.06, 1.09].map((x, k) => lying(10 + k, 7, x));
    const pair = [lying(20, 8, 0.01), lying(21, 8, 0.02)];
    expect(groupLying([...near, ...far, ...pair]).map(({ ids }) => ids.length)).toEqual([4, 3]);
  });

  it("keep a name that is a number, or that has nothing in common", () => {
    expect(commonName(["12", "13"])).toBe("12");
    expect(commonName(["washer 1", "ring 2"])).toBe("washer 1");
    expect(commonName(["washer:1", "washer:12"])).toBe("washer");
    expect(commonName([])).toBe("");
  });
});

describe("labels", () => {
  it("that would cover one that comes before are left out", () => {
    const at = (x: number, y: number) => ({ x, y, width: 40, height: 16 });
    expect(withoutOverlaps([at(0, 0), at(30, 5), at(30, 20), at(200, 0)])).toEqual([true, false, true, true]);
  });
});
