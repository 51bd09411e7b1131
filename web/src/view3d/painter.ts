/** Draws one picture: for the screen, for two eyes without a headset, or for a headset. */

import { Vector3, type Camera, type PerspectiveCamera, type Scene, type WebGLRenderer } from "three";
import type { ViewState } from "../model/view_state";
import type { CameraRig } from "./camera_rig";
import type { SceneView } from "./scene_view";
import { StereoView } from "./stereo_view";
import type { ViewCube } from "./view_cube";

export class Painter {
  private readonly stereo = new StereoView();

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly scene: Scene,
    private readonly rig: CameraRig,
    private readonly product: SceneView,
    private readonly cube: ViewCube,
    private readonly view: ViewState,
  ) {}

  dispose(): void {
    this.stereo.dispose();
  }

  /** @param vrEyes  Where a headset is drawn for. */
  draw(width: number, height: number, vrEyes: PerspectiveCamera): void {
    const { renderer, view, rig } = this;
    // Both eyes of a headset are nearer than the rig's cameras.
    const pixels = renderer.xr.isPresenting ? null : (distance: number) => 1 / rig.metresPerPixel(distance, height);
    this.product.parts?.fitDetail(rig.camera.position, pixels);
    if (renderer.xr.isPresenting) {
      renderer.clear();
      renderer.render(this.scene, vrEyes);
      return;
    }
    renderer.setViewport(0, 0, width, height);
    renderer.clear();
    const stereo = view.stereo.peek();
    if (stereo !== "anaglyph") {
      this.stereo.dispose();
    }
    if (stereo === "none") {
      this.drawScreen(rig.camera, width, height);
    } else {
      const { target } = rig.pose();
      const focus = new Vector3(...target).distanceTo(rig.camera.position);
      this.stereo.render(renderer, this.scene, rig.perspective, stereo, { width, height, focus });
    }
  }

  private drawScreen(camera: Camera, width: number, height: number): void {
    const { renderer } = this;
    renderer.render(this.scene, camera);
    if (this.view.section.peek() !== null) {
      renderer.clearStencil();
      renderer.render(this.product.caps.scene, camera);
    }
    if (this.product.scene !== null && this.view.showsCube.peek()) {
      this.cube.render(renderer, this.rig.camera, width, height);
    }
  }
}
