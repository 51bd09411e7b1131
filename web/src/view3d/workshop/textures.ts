/** Surfaces of the workshop, drawn when they are needed: no picture is loaded. */

import { CanvasTexture, LinearMipmapNearestFilter, RepeatWrapping } from "three";

/** A stream of numbers from 0 to 1, the same each time (mulberry32). */
export function makeRandom(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

type Draw = (pen: CanvasRenderingContext2D, size: number, random: () => number) => void;

/** @param across  Of the surface that one picture covers [m]; for uv in metres. */
function makeTexture(size: number, across: number, seed: number, draw: Draw): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  draw(canvas.getContext("2d")!, size, makeRandom(seed));
  const texture = new CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.repeat.set(1 / across, 1 / across);
  texture.minFilter = LinearMipmapNearestFilter; // Half the work of blending two of its sizes, for each pixel.
  return texture;
}

/** Planks along x, each of its own tone, with grain. */
export function makeWood(): CanvasTexture {
  const planks = 5;
  return makeTexture(512, 0.8, 11, (pen, size, random) => {
    const high = size / planks;
    for (let k = 0; k < planks; k++) {
      const light = 50 + 7 * random();
      pen.fillStyle = `hsl(${31 + 4 * random()} 34% ${light}%)`;
      pen.fillRect(0, k * high, size, high);
      for (let line = 0; line < 34; line++) {
        const y = k * high + high * random();
        const bend = 5 * (random() - 0.5);
        pen.strokeStyle = `hsl(28 38% ${light - 6 - 10 * random()}% / ${0.12 + 0.25 * random()})`;
        pen.lineWidth = 0.6 + 1.1 * random();
        pen.beginPath();
        pen.moveTo(0, y);
        pen.bezierCurveTo(size / 3, y + bend, (2 * size) / 3, y - bend, size, y);
        pen.stroke();
      }
      pen.fillStyle = "rgb(40 26 14 / 55%)";
      pen.fillRect(0, k * high, size, 1.4);
    }
  });
}

/** A board with holes for hooks. */
export function makePegboard(): CanvasTexture {
  return makeTexture(128, 0.1, 41, (pen, size) => {
    pen.fillStyle = "#b9a27e";
    pen.fillRect(0, 0, size, size);
    pen.fillStyle = "#3a3024";
    for (let k = 0; k < 16; k++) {
      pen.beginPath();
      pen.arc((0.5 + (k % 4)) * (size / 4), (0.5 + Math.floor(k / 4)) * (size / 4), size / 32, 0, 2 * Math.PI);
      pen.fill();
    }
  });
}
