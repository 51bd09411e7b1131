/** Two pictures for two eyes without a headset: side by side, or red and cyan glasses. */

import { StereoCamera, type PerspectiveCamera, type Scene, type WebGLRenderer } from "three";
import { AnaglyphEffect } from "three/addons/effects/AnaglyphEffect.js";
import type { Stereo } from "../model/view_state";

/** Between the eyes, as a share of the distance: easy to look at, however small the product. */
const kEyeShare = 1 / 30;

export interface StereoSize {
  width: number;
  height: number;
  /** From the eyes to what is looked at [m]. */
  focus: number;
}

export class StereoView {
  private readonly eyes = new StereoCamera();
  private anaglyph: AnaglyphEffect | null = null;
  private sizeKey = "";

  render(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, stereo: Stereo, size: StereoSize): void {
    camera.focus = size.focus;
    if (stereo === "anaglyph") {
      this.anaglyph ??= new AnaglyphEffect(renderer);
      this.resize(this.anaglyph, renderer, size);
      this.anaglyph.eyeSep = size.focus * kEyeShare;
      this.anaglyph.planeDistance = size.focus;
      renderer.autoClear = true;
      this.anaglyph.render(scene, camera);
      renderer.autoClear = false;
      return;
    }
    this.eyes.eyeSep = size.focus * kEyeShare;
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

  /** Frees the pictures of both eyes; they are made anew when they are wanted. */
  dispose(): void {
    this.anaglyph?.dispose();
    this.anaglyph = null;
    this.sizeKey = "";
  }

  /** The effect sizes the canvas as well, and fixes it to pixels: that is the page's to decide. */
  private resize(effect: AnaglyphEffect, renderer: WebGLRenderer, size: StereoSize): void {
    const key = `${size.width}/${size.height}/${renderer.getPixelRatio()}`;
    if (key !== this.sizeKey) {
      this.sizeKey = key;
      effect.setSize(size.width, size.height);
      renderer.domElement.style.width = renderer.domElement.style.height = "";
    }
  }
}
