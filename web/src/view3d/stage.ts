/** What stands around the product: light, shadow, floor. */

import {
  AmbientLight,
  DirectionalLight,
  Group,
  HemisphereLight,
  Mesh,
  PCFShadowMap,
  PlaneGeometry,
  ShadowMaterial,
  Vector3,
  type Box3,
  type Sphere,
  type WebGLRenderer,
} from "three";
import { Fixture } from "./fixture";
import { FloorGrid } from "./floor_grid";
import { disposeTree } from "./lifetime";
import type { Palette } from "./palette";

export class Stage {
  readonly root = new Group();
  private readonly sun = new DirectionalLight(0xffffff, 2.2);
  private readonly fill = new DirectionalLight(0xdfe9ff, 0.7);
  private readonly sky = new HemisphereLight(0xffffff, 0x6f7684, 1.25);
  private readonly base = new AmbientLight(0xffffff, 0.25);
  private readonly grid = new FloorGrid();
  private readonly fixture = new Fixture();
  private readonly shade: Mesh<PlaneGeometry, ShadowMaterial>;

  constructor() {
    this.sky.position.set(0, 0, 1);
    this.shade = new Mesh(new PlaneGeometry(1, 1), new ShadowMaterial({ opacity: 0.25 }));
    this.shade.receiveShadow = true;
    this.shade.renderOrder = -1;
    this.shade.material.depthWrite = false;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -2e-4;
    this.sun.shadow.normalBias = 0.0008;
    this.sun.shadow.radius = 4;
    this.root.add(this.sun, this.sun.target, this.fill, this.fill.target, this.sky, this.base);
    this.root.add(this.grid.object, this.shade, this.fixture.root);
  }

  dispose(): void {
    this.fixture.dispose();
    disposeTree(this.root);
  }

  /** Sets light and floor for parts in this sphere on a table of this height [m].
   @param base    Box of what stands in the fixture: it may be above the table.
   @param others  Boxes of the other parts in their places. */
  fit(sphere: Sphere, cellRadius: number, tableZ: number, base: Box3, others: readonly Box3[]): void {
    const { center, radius } = sphere;
    this.grid.fit(center.x, center.y, tableZ - 1e-4, cellRadius);
    this.shade.position.set(center.x, center.y, tableZ - 1e-4);
    this.shade.scale.set(6 * radius, 6 * radius, 1);
    this.sun.position.copy(center).add(new Vector3(-1.1, -1.5, 2.9).multiplyScalar(radius));
    this.fill.position.copy(center).add(new Vector3(3, 2.5, 1.2).multiplyScalar(radius));
    this.sun.target.position.copy(center);
    this.fill.target.position.copy(center);
    const camera = this.sun.shadow.camera;
    camera.left = camera.bottom = -1.5 * radius;
    camera.right = camera.top = 1.5 * radius;
    camera.near = 0.2 * radius;
    camera.far = 8 * radius;
    camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.003 * radius;
    this.fixture.place(tableZ, base, others);
  }

  setPalette(palette: Palette): void {
    this.grid.setInk(palette.grid, palette.isDark ? 0.5 : 0.62);
    this.fixture.setDark(palette.isDark);
    this.shade.material.opacity = palette.isDark ? 0.42 : 0.22;
    this.sky.intensity = palette.isDark ? 1.15 : 1.45;
  }

  setGridShown(isShown: boolean): void {
    this.grid.object.visible = isShown;
  }

  setShadows(hasShadow: boolean, renderer: WebGLRenderer): void {
    renderer.shadowMap.enabled = hasShadow;
    renderer.shadowMap.type = PCFShadowMap;
    this.sun.castShadow = hasShadow;
    this.shade.visible = hasShadow;
  }
}
