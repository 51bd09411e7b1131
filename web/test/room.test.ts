import { describe, expect, it } from "vitest";
import type { Vec3 } from "../src/model/math";
import { kScales, placeBefore, pullRoom, scaleRoom, toRoom, turnRoom, type RoomPlacement } from "../src/model/room";

const close = (a: Vec3, b: Vec3) => a.forEach((v, k) => expect(v).toBeCloseTo(b[k]!, 9));
const some: RoomPlacement = { p: [0.3, 0.8, -0.5], yaw: 0.4, scale: 2 };

describe("the world in the room", () => {
  it("stands upright: its z is the room's y, its y goes away from the eyes", () => {
    const placement = { p: [0, 0, 0] as Vec3, yaw: 0, scale: 1 };
    close(toRoom(placement, [0, 0, 1]), [0, 1, 0]);
    close(toRoom(placement, [0, 1, 0]), [0, 0, -1]);
    close(toRoom(placement, [1, 0, 0]), [1, 0, 0]);
  });

  it("comes before the eyes within arms' reach, wherever they look", () => {
    for (const yaw of [0, 1.2, -2.5]) {
      const head = { p: [0.4, 1.65, -0.2] as Vec3, yaw };
      const placement = placeBefore(head, [0.1, 0.2, 0.05], 0.3, "standing");
      const at = toRoom(placement, [0.1, 0.2, 0.05]);
      const away = [at[0] - head.p[0], at[2] - head.p[2]] as const;
      expect(Math.hypot(...away)).toBeGreaterThan(0.4);
      expect(Math.hypot(...away)).toBeLessThan(1);
      expect(Math.atan2(-away[0], -away[1])).toBeCloseTo(yaw, 9);
      expect(at[1]).toBeLessThan(1.3);
    }
  });

  it("is nearer and higher above the floor for somebody who sits, and never under a table", () => {
    const seated = placeBefore({ p: [0, 1.2, 0], yaw: 0 }, [0, 0, 0], 0.3, "seated");
    const standing = placeBefore({ p: [0, 1.2, 0], yaw: 0 }, [0, 0, 0], 0.3, "standing");
    expect(-seated.p[2]).toBeLessThan(-standing.p[2]);
    expect(placeBefore({ p: [0, 0.3, 0], yaw: 0 }, [0, 0, 0], 0.3, "seated").p[1]).toBeCloseTo(0.55);
  });

  it("is as large as it is, or made smaller, and never larger than three times", () => {
    expect(placeBefore({ p: [0, 1.6, 0], yaw: 0 }, [0, 0, 0], 2, "standing").scale).toBeCloseTo(0.45 / 2);
    expect(placeBefore({ p: [0, 1.6, 0], yaw: 0 }, [0, 0, 0], 0.01, "standing").scale).toBe(3);
  });
});

describe("turning and scaling", () => {
  it("leave the point that they are about where it is", () => {
    const point: Vec3 = [0.1, 0.2, 0.3];
    const about = toRoom(some, point);
    close(toRoom(turnRoom(some, about, 0.7), point), about);
    close(toRoom(scaleRoom(some, about, 1.9), point), about);
  });

  it("end at the limits of scale", () => {
    expect(scaleRoom(some, [0, 0, 0], 1e6).scale).toBe(kScales.most);
    expect(scaleRoom(some, [0, 0, 0], 1e-6).scale).toBe(kScales.least);
  });

  it("by both hands keep in each hand what was in it, where they stay level", () => {
    const inA: Vec3 = [0.05, 0, 0.1];
    const inB: Vec3 = [0.25, 0.1, 0.1];
    const from = { a: toRoom(some, inA), b: toRoom(some, inB) };
    const to = { a: [-0.2, 1, -0.3] as Vec3, b: [0.1, 1, -0.9] as Vec3 };
    const after = pullRoom(some, from, to);
    close(toRoom(after, inA), to.a);
    close(toRoom(after, inB), to.b);
  });

  it("by both hands at rest change nothing", () => {
    const hands = { a: [0, 1, -0.4] as Vec3, b: [0.3, 1.2, -0.5] as Vec3 };
    const after = pullRoom(some, hands, hands);
    close(after.p, some.p);
    expect(after.yaw).toBeCloseTo(some.yaw);
    expect(after.scale).toBeCloseTo(some.scale);
  });
});
