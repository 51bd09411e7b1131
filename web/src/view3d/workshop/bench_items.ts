/** Tools and fixtures as they stand on the bench: z up, on z = 0, metres of the real things. */

import {
  BoxGeometry,
  BufferAttribute,
  Color,
  CylinderGeometry,
  LatheGeometry,
  Matrix4,
  TorusGeometry,
  Vector2,
  type BufferGeometry,
} from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import type { BenchKind } from "../../model/bench";

const kSteel = 0xa9b1ba;
const kDark = 0x3b424b;
const kBlue = 0x2f5f98;
const kWood = 0xb98a54;
const kRed = 0xb5372f;
const kYellow = 0xd8a52c;

type Turn = readonly [number, number, number];

function put(geometry: BufferGeometry, color: number, at: Turn, turn: Turn = [0, 0, 0]): BufferGeometry {
  const matrix = new Matrix4()
    .makeTranslation(...at)
    .multiply(new Matrix4().makeRotationZ(turn[2]))
    .multiply(new Matrix4().makeRotationY(turn[1]))
    .multiply(new Matrix4().makeRotationX(turn[0]));
  geometry.applyMatrix4(matrix);
  const { r, g, b } = new Color(color);
  const count = geometry.getAttribute("position").count;
  const colors = new Float32Array(3 * count);
  for (let k = 0; k < count; k++) {
    colors.set([r, g, b], 3 * k);
  }
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  return geometry.index === null ? geometry : geometry.toNonIndexed();
}

const box = (x: number, y: number, z: number) => new BoxGeometry(x, y, z);
/** Along z. */
const rod = (radius: number, length: number, sides = 24) =>
  new CylinderGeometry(radius, radius, length, sides).rotateX(Math.PI / 2);
/** Turned about z: radius and height in pairs. */
const turned = (...profile: readonly (readonly [number, number])[]) =>
  new LatheGeometry(profile.map(([r, z]) => new Vector2(r, z)), 32).rotateX(Math.PI / 2);
const kAlongX: Turn = [0, Math.PI / 2, 0];
const kAlongY: Turn = [Math.PI / 2, 0, 0];

const kBuilders: Record<BenchKind, () => BufferGeometry[]> = {
  vise: () => [
    put(box(0.1, 0.12, 0.03), kBlue, [0, 0, 0.015]),
    put(box(0.09, 0.045, 0.07), kBlue, [0, 0.035, 0.065]),
    put(box(0.09, 0.035, 0.07), kBlue, [0, -0.055, 0.065]),
    put(box(0.1, 0.008, 0.03), kSteel, [0, 0.01, 0.085]),
    put(box(0.1, 0.008, 0.03), kSteel, [0, -0.034, 0.085]),
    put(rod(0.011, 0.11), kSteel, [0, -0.06, 0.05], kAlongY),
    put(rod(0.005, 0.11), kSteel, [0, -0.115, 0.05], kAlongX),
  ],
  chuck: () => [
    put(rod(0.075, 0.02, 40), kDark, [0, 0, 0.01]),
    put(rod(0.065, 0.045, 40), kSteel, [0, 0, 0.0425]),
    ...[0, 1, 2].map((k) => {
      const angle = (2 * Math.PI * k) / 3;
      return put(box(0.038, 0.018, 0.03), kDark, [0.037 * Math.cos(angle), 0.037 * Math.sin(angle), 0.08], [0, 0, angle]);
    }),
  ],
  hammer: () => [
    put(rod(0.012, 0.26), kWood, [0.02, 0, 0.016], kAlongX),
    put(rod(0.016, 0.05), kSteel, [-0.115, 0.028, 0.016], kAlongY),
    put(box(0.03, 0.045, 0.03), kSteel, [-0.115, -0.018, 0.016]),
  ],
  screwdriver: () => [
    put(turned([0, 0], [0.013, 0.004], [0.016, 0.03], [0.011, 0.085], [0.014, 0.1], [0, 0.1]), kRed, [0.02, 0, 0.016], kAlongX),
    put(rod(0.003, 0.13), kSteel, [-0.045, 0, 0.016], kAlongX),
    put(box(0.012, 0.007, 0.0015), kSteel, [-0.113, 0, 0.016]),
  ],
  spanner: () => [
    put(box(0.14, 0.016, 0.006), kSteel, [0, 0, 0.003]),
    put(new TorusGeometry(0.014, 0.006, 8, 20).scale(1, 1, 0.5), kSteel, [0.078, 0, 0.003]),
    put(box(0.014, 0.028, 0.006), kSteel, [-0.07, 0, 0.003]),
    put(box(0.022, 0.009, 0.006), kSteel, [-0.086, 0.012, 0.003], [0, 0, 0.25]),
    put(box(0.022, 0.009, 0.006), kSteel, [-0.086, -0.012, 0.003], [0, 0, -0.25]),
  ],
  caliper: () => [
    put(box(0.22, 0.016, 0.004), kSteel, [0, 0, 0.006]),
    put(box(0.012, 0.045, 0.004), kSteel, [-0.1, -0.025, 0.006]),
    put(box(0.06, 0.03, 0.008), kDark, [-0.045, 0.002, 0.007]),
    put(box(0.012, 0.045, 0.004), kSteel, [-0.07, -0.028, 0.006]),
    put(box(0.03, 0.014, 0.002), 0xb9c7b2, [-0.04, 0.002, 0.012]),
  ],
  tray: () => [
    put(box(0.2, 0.13, 0.004), kYellow, [0, 0, 0.002]),
    put(box(0.2, 0.004, 0.045), kYellow, [0, 0.063, 0.0225]),
    put(box(0.2, 0.004, 0.03), kYellow, [0, -0.063, 0.015]),
    put(box(0.004, 0.13, 0.04), kYellow, [0.098, 0, 0.02]),
    put(box(0.004, 0.13, 0.04), kYellow, [-0.098, 0, 0.02]),
    put(box(0.004, 0.12, 0.028), kYellow, [0.01, 0, 0.014]),
  ],
  vblock: () => [
    put(box(0.09, 0.06, 0.022), kDark, [0, 0, 0.011]),
    put(box(0.09, 0.034, 0.012).translate(0, 0, -0.006), kDark, [0, 0.017, 0.042], [0.785, 0, 0]),
    put(box(0.09, 0.034, 0.012).translate(0, 0, -0.006), kDark, [0, -0.017, 0.042], [-0.785, 0, 0]),
  ],
};

export function makeBenchItem(kind: BenchKind): BufferGeometry {
  const parts = kBuilders[kind]();
  const merged = mergeGeometries(parts.map((g) => g.deleteAttribute("uv")));
  parts.forEach((g) => g.dispose());
  merged.computeBoundingBox();
  return merged;
}
