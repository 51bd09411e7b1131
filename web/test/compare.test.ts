import { describe, expect, it } from "vitest";
import {
  commonPaths,
  depthOverTime,
  differencePercent,
  findHold,
  forceOverDepth,
  forceOverTime,
  partRows,
  totalOf,
} from "../src/model/compare";
import { makeBars } from "../src/model/histogram";
import { forceShare, isPointerHand, leaderOf, parseScale } from "../src/model/hands";
import { heldAt, markedSpan, rangeOf, type PlotClock } from "../src/model/plot_range";
import { makeRun } from "../src/model/recordings";
import type { Client, HandSetup, PartResult, RecordedEvent, RecordingDetail } from "../src/protocol/messages";
import { kPeriodNs, toyDetail, toyFrames } from "./toy_recording";

function result(path: string, occurrence: number, more: Partial<PartResult> = {}): PartResult {
  return {
    occurrence,
    path,
    is_seated: true,
    time_s: 2,
    path_m: 0.5,
    peak_true_n: 10,
    peak_felt_n: 4,
    collisions: 1,
    insertion_mm: 30,
    ...more,
  };
}

const at = (moment: number) => moment * kPeriodNs;

function detail(events: RecordedEvent[], results: PartResult[]): RecordingDetail {
  return { ...toyDetail(events, at(600) / 1e9), results };
}

describe("the hold of a part", () => {
  const events: RecordedEvent[] = [
    { event: "taken", hand: 0, occurrence: 1, t_ns: at(10) },
    { event: "dropped", hand: 0, occurrence: 1, was_seated: false, t_ns: at(50) },
    { event: "taken", hand: 1, occurrence: 1, t_ns: at(100) },
    { event: "taken", hand: 0, occurrence: 2, t_ns: at(110) },
    { event: "dropped", hand: 1, occurrence: 1, was_seated: true, t_ns: at(200) },
    { event: "taken", hand: 0, occurrence: 1, t_ns: at(300) },
    { event: "dropped", hand: 0, occurrence: 1, was_seated: false, t_ns: at(310) },
  ];
  const toy = detail(events, [result("toy/a", 1), result("toy/b", 2), result("toy/c", 3)]);

  it("is the one that seated it, in the hand that did it", () => {
    expect(findHold(toy, "toy/a")).toEqual({ hand: 1, fromS: at(100) / 1e9, toS: at(200) / 1e9 });
  });

  it("goes to the end where the part was never let go", () => {
    expect(findHold(toy, "toy/b")).toEqual({ hand: 0, fromS: at(110) / 1e9, toS: at(600) / 1e9 });
  });

  it("is none for a part that was never held, and everything for no part", () => {
    expect(findHold(toy, "toy/c")).toBeNull();
    expect(findHold(toy, "toy/unknown")).toBeNull();
    expect(findHold(toy, null)).toEqual({ hand: 0, fromS: 0, toS: at(600) / 1e9 });
  });
});

describe("the curves of a hold", () => {
  /** In, half back, and in to the end: the force is that of the depth, and 7 N more on the second way in. */
  const depthAt = (k: number) => (k < 100 ? k : k < 150 ? 200 - k : k < 300 ? k - 100 : 200) / 1e4;
  const run = makeRun(
    detail([], []),
    toyFrames(400, (k) => ({
      state: k < 20 ? 1 : 4,
      depth_m: depthAt(k),
      f_felt_W_n: [3, 4, k >= 150 ? 12 : 0],
      f_true_W_n: [0, 0, 30],
    })),
  );
  const hold = { hand: 0, fromS: at(5) / 1e9, toS: at(350) / 1e9 };

  it("begin when the part was taken", () => {
    const force = forceOverTime(run, hold, "felt");
    expect(force.x[0]).toBeCloseTo(0, 9);
    expect(force.x.at(-1)).toBeCloseTo(at(345) / 1e9, 6);
    expect(force.y[0]).toBeCloseTo(5, 5);
    expect(force.y.at(-1)).toBeCloseTo(13, 5);
    expect(forceOverTime(run, hold, "true").y[0]).toBeCloseTo(30, 5);
    expect(Math.max(...depthOverTime(run, hold).y)).toBeCloseTo(20, 4);
  });

  it("over depth go inwards only, each depth once, and not before a mate guides the part", () => {
    const { x, y } = forceOverDepth(run, hold, "felt");
    expect(x.every((depth, k) => k === 0 || depth > x[k - 1]!)).toBe(true);
    expect(x[0]).toBeCloseTo(2, 4);
    expect(x.at(-1)).toBeCloseTo(20, 4);
    expect(y[x.findIndex((depth) => depth > 9)]).toBeCloseTo(5, 5);
    expect(y[x.findIndex((depth) => depth > 11)]).toBeCloseTo(13, 5);
  });

  it("are empty for a hand that there was not", () => {
    expect(forceOverTime(run, { ...hold, hand: 1 }, "felt")).toEqual({ x: [], y: [] });
  });

  it("keep a single peak among many samples", () => {
    const long = makeRun(
      detail([], []),
      toyFrames(9000, (k) => ({ f_felt_W_n: [0, 0, k === 4321 ? 40 : 1] })),
    );
    const { x, y } = forceOverTime(long, { hand: 0, fromS: 0, toS: 1e3 }, "felt");
    expect(x.length).toBeLessThanOrEqual(1502);
    expect(Math.max(...y)).toBe(40);
    expect(Math.abs(x[y.indexOf(40)]! - at(4321) / 1e9)).toBeLessThan(0.25);
    expect(x.every((time, k) => k === 0 || time > x[k - 1]!)).toBe(true);
  });
});

describe("the table", () => {
  const first = detail([], [result("a", 1), result("b", 2, { time_s: 3, peak_true_n: 50 })]);
  const second = detail([], [result("b", 9, { time_s: 6 }), result("c", 3)]);

  it("has each part once, by its path and not by its number", () => {
    expect(partRows([first, second]).map((row) => [row.path, ...row.cells.map((cell) => cell?.time_s ?? null)])).toEqual([
      ["a", 2, null],
      ["b", 3, 6],
      ["c", null, 2],
    ]);
  });

  it("sums what adds up and takes the greatest of the forces", () => {
    expect(totalOf(first, new Set(["a", "b"]))).toEqual({ time_s: 5, path_m: 1, peak_true_n: 50, peak_felt_n: 4, collisions: 2 });
    expect(totalOf(detail([], []), new Set()).peak_true_n).toBe(0);
  });

  it("compares the parts that all recordings have, and no others", () => {
    const common = commonPaths([first, second]);
    expect([...common]).toEqual(["b"]);
    expect([totalOf(first, common).time_s, totalOf(second, common).time_s]).toEqual([3, 6]);
    expect([...commonPaths([first])]).toEqual(["a", "b"]);
    expect(commonPaths([first, detail([], [])]).size).toBe(0);
  });

  it("tells differences from the first in per cent", () => {
    expect(differencePercent(3, 2)).toBeCloseTo(50, 12);
    expect(differencePercent(1, 2)).toBeCloseTo(-50, 12);
    expect(differencePercent(0, 0)).toBe(0);
    expect(differencePercent(1, 0)).toBeNull();
  });
});

describe("what the plots show", () => {
  const live: PlotClock = { nowS: 1000, beginS: 400, endS: 1000, isReplay: false };
  const replay: PlotClock = { nowS: 2, beginS: 0, endS: 60, isReplay: true };

  it("goes along with now", () => {
    expect(rangeOf(8, null, live)).toEqual({ fromS: 992, toS: 1000 });
  });

  it("goes along with the moment that is played, and stays within the recording", () => {
    expect(rangeOf(8, null, replay)).toEqual({ fromS: 0, toS: 8 });
    expect(rangeOf(8, null, { ...replay, nowS: 30 })).toEqual({ fromS: 24, toS: 32 });
    expect(rangeOf(8, null, { ...replay, nowS: 60 })).toEqual({ fromS: 52, toS: 60 });
    expect(rangeOf(600, null, { ...replay, nowS: 30 })).toEqual({ fromS: 0, toS: 60 });
  });

  it("is what was marked, whatever the time is", () => {
    const span = markedSpan(7, 5);
    expect(span).toEqual({ fromS: 5, toS: 7 });
    expect(rangeOf(8, span, replay)).toEqual(span);
    expect(markedSpan(5, 5.05)).toBeNull();
  });

  it("can be held back to a time, and at the end goes along again", () => {
    expect(heldAt(700, { fromS: 992, toS: 1000 }, live)).toEqual({ fromS: 692, toS: 700 });
    expect(heldAt(100, { fromS: 992, toS: 1000 }, live)).toEqual({ fromS: 392, toS: 400 });
    expect(heldAt(1000, { fromS: 692, toS: 700 }, live)).toBeNull();
  });
});

describe("a histogram", () => {
  it("shows a single late tick among a thousand", () => {
    const bars = makeBars([100, 1000], [999, 0, 1]);
    expect(bars.map((bar) => [bar.fromUs, bar.toUs, bar.count])).toEqual([
      [0, 100, 999],
      [100, 1000, 0],
      [1000, Infinity, 1],
    ]);
    expect(bars[0]?.height).toBe(1);
    expect(bars[1]?.height).toBe(0);
    expect(bars[2]?.height).toBeCloseTo(0.1003, 4);
  });
});

describe("hands", () => {
  const mouse: HandSetup = {
    hand: 0,
    device: { index: 0, name: "Mouse", model: "", serial: "", is_emulated: false, has_force: true, has_torque: true, max_force_n: 8, scale: 1, notes: [] },
    condition: "ready",
    lease: null,
  };
  const touch: HandSetup = { ...mouse, hand: 1, device: { ...mouse.device, index: 5 } };

  it("follow the mouse where they are the mouse's and this page leads them", () => {
    expect(isPointerHand([mouse, touch], [0, 1], 0)).toBe(true);
    expect(isPointerHand([mouse, touch], [0, 1], 1)).toBe(false);
    expect(isPointerHand([mouse, touch], [1], 0)).toBe(false);
    expect(isPointerHand([], [0], 0)).toBe(true);
    expect(isPointerHand([], [0], 1)).toBe(false);
  });

  it("have a scale that is a sound number, or none", () => {
    expect(["", " 1.5 ", "0,25", "0", "-1", "x", "1e9"].map(parseScale)).toEqual([0, 1.5, 0.25, null, null, null, null]);
  });

  it("follow the mouse with an emulated device in them", () => {
    const emulated = { ...touch, device: { ...touch.device, is_emulated: true } };
    expect(isPointerHand([mouse, emulated], [0, 1], 1)).toBe(true);
  });

  it("are led by one client each", () => {
    const clients: Client[] = [
      { id: "c1", name: "", role: "operator", has_lease: true, hands: [0] },
      { id: "c2", name: "", role: "operator", has_lease: false, hands: [1] },
    ];
    expect([0, 1, 2].map((hand) => leaderOf(clients, hand)?.id)).toEqual(["c1", "c2", undefined]);
  });

  it("tell their force as a share of the most", () => {
    expect(forceShare(2, 8)).toBe(0.25);
    expect(forceShare(9, 8)).toBe(1);
    expect(forceShare(1, null)).toBe(0);
  });
});
