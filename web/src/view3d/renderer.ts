/** What draws all pictures of a canvas, on whatever the page has behind it. */

import { WebGLRenderer } from "three";

export function makeRenderer(canvas: HTMLCanvasElement): WebGLRenderer {
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, stencil: true });
  renderer.localClippingEnabled = true;
  renderer.autoClear = false;
  renderer.setClearColor(0x000000, 0);
  return renderer;
}
