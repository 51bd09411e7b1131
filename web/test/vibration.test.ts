import { describe, expect, it } from "vitest";
import { Vibration } from "../src/model/vibration";

const hand = (more: object) => ({
  state: 1,
  contact_count: 0,
  axial_true_n: 0,
  peak_felt_n: 0,
  f_felt_W_n: [0, 0, 0] as [number, number, number],
  ...more,
});

describe("the vibration of a controller", () => {
  it("is still while nothing is felt", () => {
    const vibration = new Vibration();
    expect(vibration.next(hand({}), 0)).toBeNull();
    expect(vibration.next(hand({}), 16)).toBeNull();
  });

  it("is the stronger the harder the push, up to its limit", () => {
    const strengthOf = (newtons: number) => new Vibration().next(hand({ f_felt_W_n: [newtons, 0, 0] }), 0)?.strength ?? 0;
    expect(strengthOf(1)).toBeLessThan(strengthOf(4));
    expect(strengthOf(4)).toBeLessThan(strengthOf(7));
    expect(strengthOf(500)).toBe(1);
  });

  it("tells of the first contact, of capture and of the seat, once each", () => {
    const vibration = new Vibration();
    const states = [
      hand({}),
      hand({ contact_count: 3 }),
      hand({ contact_count: 2 }),
      hand({ state: 3 }),
      hand({ state: 4 }),
      hand({ state: 5 }),
      hand({ state: 5 }),
    ];
    const pulses = states.map((state, k) => vibration.next(state, 500 * k));
    expect(pulses.map((p) => p !== null)).toEqual([false, true, false, true, false, true, false]);
    expect(pulses[5]?.strength).toBe(1);
  });

  it("tells of a fit that sticks and slips, not of one that slides", () => {
    const ticks = (forces: number[]) => {
      const vibration = new Vibration();
      return forces.map((n, k) => vibration.next(hand({ state: 4, axial_true_n: n }), 100 * k)).filter((p) => p !== null);
    };
    expect(ticks([10, 30, 12, 34, 9, 31])).toHaveLength(2);
    expect(ticks([10, 11, 12, 11.5, 12, 11.8])).toHaveLength(0);
  });

  it("does not cut an event short by the push that goes on", () => {
    const vibration = new Vibration();
    vibration.next(hand({ state: 4, f_felt_W_n: [5, 0, 0] }), 0);
    expect(vibration.next(hand({ state: 5, f_felt_W_n: [5, 0, 0] }), 16)?.ms).toBe(90);
    expect(vibration.next(hand({ state: 5, f_felt_W_n: [5, 0, 0] }), 32)).toBeNull();
    expect(vibration.next(hand({ state: 5, f_felt_W_n: [5, 0, 0] }), 110)).not.toBeNull();
  });
});
