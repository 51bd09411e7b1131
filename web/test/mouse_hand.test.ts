import { describe, expect, it } from "vitest";
import { distance, lerp, toVec3, type Pose, type Vec3 } from "../src/model/math";
import type { HandState } from "../src/protocol/frames";
import { MouseHand, type Eye } from "../src/view3d/mouse_hand";

/** An eye that looks along y from far away: parallel, a millimetre a pixel. */
const eye: Eye = {
  back: [0, -1, 0],
  right: [1, 0, 0],
  up: [0, 0, 1],
  rayTo: (p) => ({ from: [p[0], -10, p[2]], along: [0, 1, 0] }),
  metresPerPixel: () => 1e-3,
};
const kPeriod = 1 / 60;
const start: Pose = { p: [0.3, 0.1, 0], q: [1, 0, 0, 0] };
const goal: Pose = { p: [0, 0, 0.05], q: [1, 0, 0, 0] };

function take(): MouseHand {
  const hand = new MouseHand();
  const step = { kind: "insert", occurrence: 4, members: [], way_in: [0, 0, -1] as Vec3, distance_m: 0.05 } as const;
  hand.begin({ occurrence: 4, X_WB: start, goal, step: { ...step, members: [] }, radius: 0.03, clearance: 0.05, members: [], tablePlaces: [] }, start);
  return hand;
}

/** What the server would say if the part followed the hand at once. `p_HB`: where the hand has it. */
function follow(p: readonly number[], p_HB: Vec3 = [0, 0, 0]): HandState {
  const q = [1, 0, 0, 0];
  const part = p.map((value, k) => value + p_HB[k]!);
  const poses = { p_WH_m: p, q_WH: q, p_WT_m: part, q_WT: q, p_WD_m: part, q_WD: q };
  return { state: 1, occurrence: 4, ...poses, axis_W: [0, 0, 0] } as unknown as HandState;
}

function run(hand: MouseHand, seconds: number): Vec3 {
  let p: readonly number[] = start.p;
  for (let k = 0; k < seconds / kPeriod; k++) {
    p = hand.update(kPeriod, follow(p), eye)?.p_WH_m ?? p;
  }
  return [p[0] ?? 0, p[1] ?? 0, p[2] ?? 0];
}

describe("the mouse hand", () => {
  it("keeps a part where it is while nothing moves, and goes on saying so", () => {
    const hand = take();
    expect(distance(run(hand, 1), start.p)).toBeLessThan(1e-9);
    expect(hand.update(kPeriod, follow(start.p), eye)?.buttons).toBe(1);
  });

  it("is led in the plane of the view", () => {
    const hand = take();
    hand.assists = false;
    hand.grab(eye.rayTo(start.p), eye);
    hand.drag(eye.rayTo([0.35, 0, 0.1]), eye, false);
    const p = run(hand, 2);
    expect(distance(p, [0.35, 0.1, 0.1])).toBeLessThan(1e-4);
  });

  it("moves a fifth in fine motion", () => {
    const hand = take();
    hand.assists = false;
    hand.grab(eye.rayTo(start.p), eye);
    hand.drag(eye.rayTo([0.4, 0, 0]), eye, true);
    expect(distance(run(hand, 2), [0.32, 0.1, 0])).toBeLessThan(1e-4);
  });

  it("is caught by the way in and finds the depth that a mouse does not have", () => {
    const hand = take();
    hand.grab(eye.rayTo(start.p), eye);
    hand.drag(eye.rayTo([0.005, 0, 0.1]), eye, false);
    const outside = run(hand, 3);
    expect(hand.isCaught).toBe(true);
    expect(distance([outside[0], outside[1], 0], [0, 0, 0])).toBeLessThan(1e-3);
    hand.drag(eye.rayTo([0.005, 0, 0.05]), eye, false);
    expect(distance(run(hand, 3), goal.p)).toBeLessThan(1e-3);
  });

  it("comes to the way in from outside, never through what is beside it", () => {
    const hand = take();
    hand.grab(eye.rayTo(start.p), eye);
    hand.drag(eye.rayTo([0, 0, 0.05]), eye, false);
    let p: readonly number[] = start.p;
    let lowest = Infinity;
    for (let k = 0; k < 240; k++) {
      p = hand.update(kPeriod, follow(p), eye)?.p_WH_m ?? p;
      const off = Math.hypot(p[0] ?? 0, p[1] ?? 0);
      if (off > 0.003 && off < 0.02) {
        lowest = Math.min(lowest, p[2] ?? 0);
      }
    }
    expect(lowest).toBeGreaterThan(0.085);
  });

  it.each([0, 0.1, 0.2, 0.4, 0.8])("goes in at one go where its part is seen %f s late", (delay) => {
    for (const [period, lag] of [[1 / 60, 0.01], [1 / 60, 0.15], [1 / 60, 0.4], [0.1, 0.05], [0.1, 0.4]] as const) {
      const hand = take();
      hand.grab(eye.rayTo(start.p), eye);
      hand.drag(eye.rayTo([0, 0, 0.04]), eye, false);
      let p: Vec3 = start.p;
      const seen: Vec3[] = [start.p];
      let outwards = 0;
      let wasOutwards = false;
      for (let k = 0; k < 20 / period; k++) {
        const late = seen[Math.max(0, seen.length - 1 - Math.round(delay / period))]!;
        const next = hand.update(period, { ...follow(late), contact_count: 0 }, eye)?.p_WH_m ?? p;
        const rise = next[2]! - p[2];
        if (Math.abs(rise) > 1e-7) {
          outwards += rise > 0 && !wasOutwards ? 1 : 0;
          wasOutwards = rise > 0;
        }
        p = toVec3(next);
        seen.push(lerp(seen.at(-1)!, p, 1 - Math.exp(-period / lag)));
      }
      expect(outwards).toBe(1);
      expect(distance(p, [0, 0, 0.04])).toBeLessThan(1e-3);
    }
  });

  it("brings in a part that rolled before the hand closed on it", () => {
    const hand = take();
    hand.grab(eye.rayTo(start.p), eye);
    hand.drag(eye.rayTo([0, 0, 0.04]), eye, false);
    const p_HB: Vec3 = [0.006, -0.004, 0.001];
    let p: readonly number[] = start.p;
    for (let k = 0; k < 300; k++) {
      p = hand.update(kPeriod, { ...follow(p, p_HB), contact_count: 0 }, eye)?.p_WH_m ?? p;
    }
    expect(hand.isCaught).toBe(true);
    expect(Math.hypot(p[0]! + p_HB[0], p[1]! + p_HB[1])).toBeLessThan(1e-4);
    expect(p[2]).toBeCloseTo(0.04, 3);
  });

  it("goes on when nothing is heard for a moment", () => {
    const hand = take();
    run(hand, 0.1);
    expect(hand.update(kPeriod, null, eye)?.buttons).toBe(1);
  });

  it("lets go when the server says that the hand is empty", () => {
    const hand = take();
    run(hand, 0.1);
    hand.update(kPeriod, { ...follow(start.p), state: 0 }, eye);
    expect(hand.occurrence).toBeNull();
  });
});
