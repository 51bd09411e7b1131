import { describe, expect, it } from "vitest";
import { ease, leash, pointAtLine, rayOnPlane, wayInLine } from "../src/model/assist";
import { clearanceOf, explodeOffsets } from "../src/model/explode";
import { Extrapolator } from "../src/model/extrapolate";
import {
  angleBetween,
  compose,
  distance,
  inverse,
  multiply,
  nearestOnLine,
  rotate,
  slerp,
  turnAbout,
  type Pose,
  type Vec3,
} from "../src/model/math";
import type { Step } from "../src/protocol/messages";

const kTolM = 1e-12;

function closeTo(a: readonly number[], b: readonly number[], tolerance = kTolM): void {
  a.forEach((v, k) => expect(Math.abs(v - (b[k] ?? NaN))).toBeLessThan(tolerance));
}

describe("poses", () => {
  const pose: Pose = { p: [0.1, -0.2, 0.3], q: turnAbout([1, 2, 3], 0.8) };

  it("times their inverse are nothing", () => {
    const none = compose(pose, inverse(pose));
    closeTo(none.p, [0, 0, 0]);
    closeTo(none.q, [1, 0, 0, 0]);
  });

  it("turn as their quaternion does", () => {
    closeTo(rotate(turnAbout([0, 0, 1], Math.PI / 2), [1, 0, 0]), [0, 1, 0]);
    closeTo(rotate(multiply(turnAbout([0, 0, 1], 0.4), turnAbout([0, 0, 1], 0.6)), [1, 0, 0]), [Math.cos(1), Math.sin(1), 0]);
  });

  it("are turned the short way, at even speed", () => {
    const a = turnAbout([0, 0, 1], 0.2);
    const b = turnAbout([0, 0, 1], 1.2).map((v) => -v) as unknown as Pose["q"];
    expect(angleBetween(a, slerp(a, b, 0.3))).toBeCloseTo(0.3, 9);
  });
});

describe("a pointer", () => {
  it("meets the plane of the view", () => {
    expect(rayOnPlane({ from: [0, 0, 1], along: [0, 0, -1] }, [0, 0, 0.25], [0, 0, 1])).toEqual([0, 0, 0.25]);
    expect(rayOnPlane({ from: [0, 0, 1], along: [1, 0, 0] }, [0, 0, 0], [0, 0, 1])).toBeNull();
    expect(rayOnPlane({ from: [0, 0, 1], along: [0, 0, 1] }, [0, 0, 0], [0, 0, 1])).toBeNull();
  });

  it("finds the nearest point of a line, as a search does", () => {
    const p: Vec3 = [0.2, 0.1, 0];
    const d: Vec3 = [0, 0.6, 0.8];
    const from: Vec3 = [1, -1, 0.5];
    const along: Vec3 = [-0.8, 0.6, 0];
    const s = nearestOnLine(p, d, from, along);
    const gap = (at: number): number => {
      const q: Vec3 = [p[0] + at * d[0], p[1] + at * d[1], p[2] + at * d[2]];
      const t = (q[0] - from[0]) * along[0] + (q[1] - from[1]) * along[1] + (q[2] - from[2]) * along[2];
      return distance(q, [from[0] + t * along[0], from[1] + t * along[1], from[2] + t * along[2]]);
    };
    for (const off of [-0.01, 0.01]) {
      expect(gap(s)).toBeLessThan(gap(s + off));
    }
  });

  it("stays between the ends of the way in", () => {
    const line = wayInLine({ p: [0, 0, 0], q: [1, 0, 0, 0] }, [0, 0, -1], 0.1);
    const above = pointAtLine({ from: [1, 0, 5], along: [-1, 0, 0] }, line);
    expect(above.p[2]).toBeCloseTo(0.1, 12);
    const below = pointAtLine({ from: [1, 0, -5], along: [-1, 0, 0] }, line);
    expect(below.p[2]).toBeCloseTo(-0.03, 12);
  });
});

describe("the hand", () => {
  it("goes half of the way in its half life, and no faster than it may", () => {
    closeTo(ease([0, 0, 0], [0.01, 0, 0], 0.05, 0.05, 10), [0.005, 0, 0]);
    closeTo(ease([0, 0, 0], [1, 0, 0], 0.1, 0.01, 0.5), [0.05, 0, 0]);
  });

  it("is kept on a leash to the displayed part", () => {
    closeTo(leash([0, 0, 0], [0, 0, 1], 0.02), [0, 0, 0.02]);
    closeTo(leash([0, 0, 0], [0, 0, 0.01], 0.02), [0, 0, 0.01]);
  });
});

describe("extrapolation", () => {
  const at = (x: number, angle: number): Pose => ({ p: [x, 0, 0], q: turnAbout([0, 0, 1], angle) });

  it("goes on as the last two frames went, in place and in turn", () => {
    const e = new Extrapolator();
    e.take(at(0, 0), 1000);
    e.take(at(0.016, 0.08), 1016);
    const guess = e.at(1024)!;
    expect(guess.p[0]).toBeCloseTo(0.024, 9);
    expect(angleBetween(guess.q, turnAbout([0, 0, 1], 0.12))).toBeLessThan(1e-6);
  });

  it("gives up guessing after a while and over gaps", () => {
    const e = new Extrapolator();
    e.take(at(0, 0), 1000);
    e.take(at(0.01, 0), 1010);
    expect(e.at(5000)!.p[0]).toBeCloseTo(0.06, 9);
    e.take(at(0.5, 0), 6000);
    expect(e.at(6020)!.p[0]).toBe(0.5);
  });
});

describe("the exploded picture", () => {
  const step = (occurrence: number, way_in: Vec3, members: number[] = []): Step => ({
    kind: "insert",
    occurrence,
    members,
    way_in,
    distance_m: 0.02,
  });
  const box = (z: number, x = 0) => ({ low: [x, 0, z] as Vec3, high: [x + 0.01, 0.01, z + 0.02] as Vec3 });

  it("moves parts out against their way in, later ones beyond earlier ones", () => {
    const offsets = explodeOffsets(
      [step(0, [0, 0, -1]), step(1, [0, 0, -1])],
      new Map([[0, box(0)], [1, box(0.02)]]),
    );
    expect(offsets.get(0)![2]).toBeGreaterThan(0);
    expect(offsets.get(1)![2]).toBeGreaterThan(offsets.get(0)![2]);
  });

  it("leaves parts side by side at one height, and takes members along", () => {
    const offsets = explodeOffsets(
      [step(0, [0, 0, -1]), step(1, [0, 0, -1], [2])],
      new Map([[0, box(0)], [1, box(0, 0.5)], [2, box(0, 0.6)]]),
    );
    expect(offsets.get(1)).toEqual(offsets.get(0));
    expect(offsets.get(2)).toEqual(offsets.get(1));
  });

  it("knows how far out a part is clear of what stands there", () => {
    const boxes = new Map([[0, box(0)], [1, box(0.005)], [2, box(0.5)]]);
    expect(clearanceOf(step(1, [0, 0, -1]), boxes, [0])).toBeCloseTo(0.02 + 0.005 + 0.006, 9);
    expect(clearanceOf(step(1, [0, 0, -1]), boxes, [2])).toBeCloseTo(0.515 + 0.011, 9);
  });
});
