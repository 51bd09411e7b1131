import { describe, expect, it } from "vitest";
import { Seen } from "../src/model/seen";

describe("what is seen", () => {
  it("is drawn anew when it has moved, come or gone", () => {
    const seen = new Seen();
    expect(seen.differs([])).toBe(false);
    expect(seen.differs([1, 2])).toBe(true);
    expect(seen.differs([1, 2])).toBe(false);
    expect(seen.differs([1, 2 + 1e-5])).toBe(true);
    expect(seen.differs([])).toBe(true);
  });

  it("is not drawn for a tremble, but for one that creeps away", () => {
    const seen = new Seen();
    expect(seen.differs([0])).toBe(true);
    const steps = Array.from({ length: 10 }, (_, k) => seen.differs([0.4e-6 * k]));
    expect(steps.filter(Boolean)).toHaveLength(3);
  });
});
