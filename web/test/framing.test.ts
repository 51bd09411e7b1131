import { describe, expect, it } from "vitest";
import { frame, kNoRim, rimOf, type Frame, type Rim, type Screen } from "../src/model/framing";
import { add, cross, dot, scale, sub, unit, type Vec3 } from "../src/model/math";

const kSlope = Math.tan((16 * Math.PI) / 180);

function screenFrom(back: Vec3, aspect: number, rim: Rim, room = 1): Screen {
  const right = unit(cross([0, 0, 1], back));
  return { right, up: cross(back, right), back, aspect, rim, room };
}

/** Where a point is seen, as shares of the width and height from the left and from the bottom. */
function seenAt(p: Vec3, middle: Vec3, screen: Screen, { size, aside, above }: Frame, slope: number | null): [number, number] {
  const o = sub(p, add(middle, add(scale(screen.right, aside), scale(screen.up, above))));
  const half = slope === null ? size : slope * (size - dot(o, screen.back));
  return [0.5 + dot(o, screen.right) / (2 * half * screen.aspect), 0.5 + dot(o, screen.up) / (2 * half)];
}

/** Numbers between 0 and 1, the same in each run. */
function randoms(seed: number): () => number {
  let state = seed;
  return () => (state = (state * 16807) % 2147483647) / 2147483647;
}

describe("the frame of a picture", () => {
  it("has all points in its free part, and two sides of one axis touch them", () => {
    const random = randoms(7);
    for (let run = 0; run < 200; run++) {
      const points = Array.from({ length: 12 }, (): Vec3 => [random() - 0.2, 3 * random(), 0.4 * random()]);
      const back = unit([random() - 0.5, random() - 0.5, random() - 0.3]);
      const rim = { left: 0.3 * random(), right: 0.2 * random(), top: 0.1 * random(), bottom: 0.3 * random() };
      const screen = screenFrom(back, 0.5 + 1.5 * random(), rim);
      const middle: Vec3 = [0.3, 1.5, 0.2];
      for (const slope of [kSlope, null]) {
        const framed = frame(points, middle, screen, slope);
        const seen = points.map((p) => seenAt(p, middle, screen, framed, slope));
        const [x, y] = [seen.map((s) => s[0]), seen.map((s) => s[1])];
        const gaps = [Math.min(...x) - rim.left, 1 - rim.right - Math.max(...x), Math.min(...y) - rim.bottom, 1 - rim.top - Math.max(...y)];
        expect(Math.min(...gaps)).toBeGreaterThan(-1e-9);
        expect(Math.min(gaps[0]! + gaps[1]!, gaps[2]! + gaps[3]!)).toBeLessThan(1e-9);
      }
    }
  });

  it("puts a point in the middle of the free part", () => {
    const screen = screenFrom([0, -1, 0], 2, { ...kNoRim, bottom: 0.2, left: 0.1 });
    const framed = frame([[1, 2, 3]], [1, 2, 3], screen, kSlope);
    const [x, y] = seenAt([1, 2, 3], [1, 2, 3], screen, framed, kSlope);
    expect(x).toBeCloseTo(0.55, 9);
    expect(y).toBeCloseTo(0.6, 9);
  });
});

describe("the rim of a picture", () => {
  const picture = { left: 100, right: 500, top: 50, bottom: 350 };

  it("counts a panel at the side where it takes away least", () => {
    const rail = { left: 110, right: 150, top: 60, bottom: 340 };
    const hint = { left: 130, right: 480, top: 300, bottom: 340 };
    const rim = rimOf(picture, [rail, hint]);
    expect(rim.left).toBeCloseTo(50 / 400, 9);
    expect(rim.bottom).toBeCloseTo(50 / 300, 9);
    expect([rim.right, rim.top]).toEqual([0, 0]);
  });

  it("passes over panels beside the picture, and never gives all of it away", () => {
    const beside = { left: 0, right: 100, top: 0, bottom: 400 };
    const large = { left: 100, right: 500, top: 60, bottom: 350 };
    expect(rimOf(picture, [beside])).toEqual(kNoRim);
    const { left, right, top, bottom } = rimOf(picture, [large]);
    expect(Math.max(left, right, top, bottom)).toBe(0.4);
  });
});
