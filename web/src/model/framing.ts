/** Where the eye has to be so that all that is to be seen lies in the part of the picture that no panel covers. */

import { dot, sub, type Vec3 } from "./math";

/** Shares of the width and height of the picture that are covered, from each side inwards. */
export interface Rim {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

export const kNoRim: Rim = { left: 0, right: 0, top: 0, bottom: 0 };

/** Also where there is but a point to be seen [m]: a choice. */
const kNearest = 1e-3;

/** A rectangle on the page [px]. */
export interface Rect {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** More of the picture than this is not given up to the panels of one side: a choice. */
const kMostCovered = 0.4;

/** What panels cover of a picture. Each of them counts for the side at which it takes away least. */
export function rimOf(picture: Rect, panels: readonly Rect[]): Rim {
  const [width, height] = [Math.max(1, picture.right - picture.left), Math.max(1, picture.bottom - picture.top)];
  const rim = { ...kNoRim };
  for (const panel of panels) {
    const covered: Rim = {
      left: (panel.right - picture.left) / width,
      right: (picture.right - panel.left) / width,
      top: (panel.bottom - picture.top) / height,
      bottom: (picture.bottom - panel.top) / height,
    };
    const sides = ["left", "right", "top", "bottom"] as const;
    const side = sides.reduce((best, each) => (covered[each] < covered[best] ? each : best));
    if (covered[side] > 0) {
      rim[side] = Math.max(rim[side], Math.min(kMostCovered, covered[side]));
    }
  }
  return rim;
}

export interface Screen {
  /** Unit vectors in W; `back` is out of the screen. */
  right: Vec3;
  up: Vec3;
  back: Vec3;
  /** Width over height. */
  aspect: number;
  rim: Rim;
  /** How many times as large as what is shown the free part of the picture is. */
  room: number;
}

/** Where the eye is: `size` in front of the middle of the points, moved by `aside` along right and `above` along up [m].
 * For a parallel picture `size` is half of the height that it shows. */
export interface Frame {
  size: number;
  aside: number;
  above: number;
}

/** What one axis of the screen asks for: a point o is within it if its tangent lies between `low` and `high`,
 * low <= (o.axis - shift) / (size - o.back) <= high. */
interface Axis {
  low: number;
  high: number;
  /** The largest of o.axis + high o.back, and the least of o.axis + low o.back. */
  most: number;
  least: number;
}

/** The nearest eye that sees all the points in the free part of the picture.
 * @param slope  Tangent of half the angle of view upwards; null for a parallel picture. */
export function frame(points: readonly Vec3[], middle: Vec3, screen: Screen, slope: number | null): Frame {
  const { rim, room, aspect } = screen;
  const offsets = points.map((p) => sub(p, middle));
  const axis = (direction: Vec3, under: number, over: number, scale: number): Axis => {
    const [centre, half] = [under - over, (1 - under - over) / room];
    const [low, high] = [scale * (centre - half), scale * (centre + half)];
    const seen = (o: Vec3, tangent: number): number => dot(o, direction) + (slope === null ? 0 : tangent * dot(o, screen.back));
    return {
      low,
      high,
      most: Math.max(...offsets.map((o) => seen(o, high))),
      least: Math.min(...offsets.map((o) => seen(o, low))),
    };
  };
  const axes = [
    axis(screen.right, rim.left, rim.right, (slope ?? 1) * aspect),
    axis(screen.up, rim.bottom, rim.top, slope ?? 1),
  ] as const;
  const size = Math.max(kNearest, ...axes.map(({ low, high, most, least }) => (most - least) / (high - low)));
  const [aside, above] = axes.map(({ low, high, most, least }) => (most + least - (low + high) * size) / 2);
  return { size, aside: aside!, above: above! };
}
