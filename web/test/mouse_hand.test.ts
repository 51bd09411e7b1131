import { describe, expect, it } from "vitest";
import { distance, type Pose, type Vec3 } from "../src/model/math";
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

/** What the server would say if the part followed the hand at once. */
function follow(p: readonly number[]): HandState {
  return { state: 1, occurrence: 4, p_WD_m: p, q_WD: [1, 0, 0, 0], axis_W: [0, 0, 0] } as unknown as HandState;
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
