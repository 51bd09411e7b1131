/** The floor as lines that fade towards the rim. Lines, not a shader over the whole floor: that alone
 would cost a machine without a graphics processor three quarters of its pictures. */

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, type Color } from "three";

const kSegments = 16;
/** Every so many lines one is stronger. */
const kMajor = 5;
/** Lines to either side of the middle. */
const kLines = 40;

/** A cell of the grid: a power of ten, or twice or five times one, about a fifth of the product. */
export function gridCell(radius: number): number {
  const wanted = radius / 3;
  const power = Math.pow(10, Math.floor(Math.log10(wanted)));
  return wanted >= 5 * power ? 5 * power : wanted >= 2 * power ? 2 * power : power;
}

function fade(x: number, y: number): number {
  const share = Math.hypot(x, y) / kLines;
  const t = Math.min(1, Math.max(0, (share - 0.15) / 0.85));
  return Math.pow(1 - t, 1.6);
}

/** In cells; the colour's alpha carries strength and fading. */
function makeLines(): BufferGeometry {
  const positions: number[] = [];
  const colors: number[] = [];
  const put = (x: number, y: number, strength: number): void => {
    positions.push(x, y, 0);
    colors.push(1, 1, 1, strength * fade(x, y));
  };
  for (let line = -kLines; line <= kLines; line++) {
    const strength = line % kMajor === 0 ? 1 : 0.38;
    for (let k = 0; k < kSegments; k++) {
      const from = kLines * ((2 * k) / kSegments - 1);
      const to = kLines * ((2 * (k + 1)) / kSegments - 1);
      put(line, from, strength);
      put(line, to, strength);
      put(from, line, strength);
      put(to, line, strength);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colors), 4));
  return geometry;
}

export class FloorGrid {
  readonly object = new LineSegments(
    makeLines(),
    new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }),
  );

  constructor() {
    this.object.renderOrder = -2;
  }

  fit(x: number, y: number, z: number, radius: number): void {
    const cell = gridCell(radius);
    const step = kMajor * cell;
    this.object.position.set(Math.round(x / step) * step, Math.round(y / step) * step, z);
    this.object.scale.set(cell, cell, 1);
  }

  setInk(ink: Color, strength: number): void {
    this.object.material.color.copy(ink);
    this.object.material.opacity = strength;
  }
}
