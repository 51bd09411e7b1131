/** Two pictures for two eyes without a headset: side by side, or red and cyan glasses. */

import { StereoCamera, type PerspectiveCamera, type Scene, type WebGLRenderer } from "three";
import { AnaglyphEffect } from "three/addons/effects/AnaglyphEffect.js";
import type { Stereo } from "../model/view_state";

export interface StereoSize {
  width: number;
  height: number;
  /** From the eyes to what is looked at [m]. */
  focus: number;
}

export class StereoView {
  private readonly eyes = new StereoCamera();
  private anaglyph: AnaglyphEffect | null = null;

  render(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, stereo: Stereo, size: StereoSize): void {
    camera.focus = size.focus;
    if (stereo === "anaglyph") {
      this.anaglyph ??= new AnaglyphEffect(renderer);
      this.anaglyph.setSize(size.width, size.height);
      renderer.autoClear = true;
      this.anaglyph.render(scene, camera);
      renderer.autoClear = false;
      return;
    }
    this.eyes.aspect = 0.5;
    // A thirtieth of the distance keeps the depth easy to look at, however small the product.
    this.eyes.eyeSep = size.focus / 30;
    camera.updateMatrixWorld();
    this.eyes.update(camera);
    const half = size.width / 2;
    renderer.setScissorTest(true);
    for (const [x, eye] of [[0, this.eyes.cameraL], [half, this.eyes.cameraR]] as const) {
      renderer.setViewport(x, 0, half, size.height);
      renderer.setScissor(x, 0, half, size.height);
      renderer.render(scene, eye);
    }
    renderer.setScissorTest(false);
  }
}
