import { describe, expect, it } from "vitest";
import { CollisionCounter } from "../src/model/collisions";
import { summarizeRuns } from "../src/model/summary";
import type { Run } from "../src/model/store";

const run = (occurrence: number, wasSeated: boolean, time_s: number, peak: number, collisions = 0): Run => ({
  occurrence,
  name: `part ${occurrence}`,
  wasSeated,
  collisions,
  metrics: {
    time_s,
    path_mm: 100,
    peak_true_n: peak,
    peak_felt_n: peak / 2,
    fit_true_n: 0,
    depth_um: 0,
    insertion_mm: 0,
    collisions,
  },
});

describe("the summary", () => {
  it("adds up times, paths and collisions, and takes the greatest force", () => {
    const sum = summarizeRuns([run(1, false, 4, 10, 2), run(1, true, 6, 30, 1), run(2, true, 3, 20)]);
    expect(sum).toMatchObject({ parts: 2, attempts: 3, timeS: 13, pathMm: 300, peakTrueN: 30, peakFeltN: 15, collisions: 3 });
    expect(sum.slowest?.metrics.time_s).toBe(6);
  });

  it("of nothing is nothing", () => {
    expect(summarizeRuns([])).toMatchObject({ parts: 0, timeS: 0, slowest: null });
  });
});

describe("collisions", () => {
  const hand = (state: number, contact_count: number, occurrence = 3) => ({ hand: 0, occurrence, state, contact_count });

  it("are contacts that begin while the part is free", () => {
    const counter = new CollisionCounter();
    // It lies on the table, is lifted, hits something twice, is captured and goes in with contact.
    for (const [state, contacts] of [[1, 4], [1, 0], [1, 2], [1, 3], [2, 0], [2, 1], [3, 0], [3, 2], [4, 0], [4, 5]] as const) {
      counter.note([hand(state, contacts)]);
    }
    expect(counter.take(0)).toBe(2);
  });

  it("begin anew with each hold", () => {
    const counter = new CollisionCounter();
    counter.note([hand(1, 0)]);
    counter.note([hand(1, 1)]);
    expect(counter.take(0)).toBe(1);
    expect(counter.take(0)).toBe(0);
    counter.note([hand(1, 1, 5)]);
    expect(counter.take(0)).toBe(0);
  });
});
