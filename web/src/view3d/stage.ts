/** What stands around the product: light, shadow, floor. */

import {
  AmbientLight,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  Mesh,
  PCFShadowMap,
  PlaneGeometry,
  ShaderMaterial,
  ShadowMaterial,
  Vector3,
  type WebGLRenderer,
} from "three";
import type { Quality } from "../model/view_state";
import type { Palette } from "./palette";

const kGridVertex = /* glsl */ `
  varying vec3 vAt;
  void main() {
    vAt = (modelMatrix * vec4(position, 1.0)).xyz;
    gl_Position = projectionMatrix * viewMatrix * vec4(vAt, 1.0);
  }
`;

/** Lines as wide as a pixel at any distance; every fifth is stronger; all fade towards the rim. */
const kGridFragment = /* glsl */ `
  uniform vec3 ink;
  uniform vec3 centre;
  uniform float cell, reach, strength;
  varying vec3 vAt;
  float lines(float size) {
    vec2 at = vAt.xy / size;
    vec2 width = fwidth(at);
    vec2 off = abs(fract(at - 0.5) - 0.5) / max(width, 1e-6);
    float line = 1.0 - min(min(off.x, off.y), 1.0);
    return line * (1.0 - smoothstep(0.25, 0.6, max(width.x, width.y)));
  }
  void main() {
    float fade = 1.0 - smoothstep(0.2, 1.0, distance(vAt.xy, centre.xy) / reach);
    float alpha = max(lines(cell) * 0.4, lines(cell * 5.0)) * fade * strength;
    if (alpha < 0.004) {
      discard;
    }
    gl_FragColor = vec4(ink, alpha);
    #include <colorspace_fragment>
  }
`;

/** A cell of the grid: a power of ten, or twice or five times one, somewhat less than the product. */
export function gridCell(radius: number): number {
  const wanted = radius / 3;
  const power = Math.pow(10, Math.floor(Math.log10(wanted)));
  return wanted >= 5 * power ? 5 * power : wanted >= 2 * power ? 2 * power : power;
}

export class Stage {
  readonly root = new Group();
  private readonly sun = new DirectionalLight(0xffffff, 2.2);
  private readonly fill = new DirectionalLight(0xdfe9ff, 0.7);
  private readonly sky = new HemisphereLight(0xffffff, 0x6f7684, 1.25);
  private readonly base = new AmbientLight(0xffffff, 0.25);
  private readonly grid: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly shade: Mesh<PlaneGeometry, ShadowMaterial>;

  constructor() {
    this.sky.position.set(0, 0, 1);
    this.grid = new Mesh(
      new PlaneGeometry(1, 1),
      new ShaderMaterial({
        vertexShader: kGridVertex,
        fragmentShader: kGridFragment,
        uniforms: {
          ink: { value: new Color() },
          centre: { value: new Vector3() },
          cell: { value: 0.01 },
          reach: { value: 1 },
          strength: { value: 1 },
        },
        transparent: true,
        depthWrite: false,
      }),
    );
    this.grid.renderOrder = -2;
    this.shade = new Mesh(new PlaneGeometry(1, 1), new ShadowMaterial({ opacity: 0.25 }));
    this.shade.receiveShadow = true;
    this.shade.renderOrder = -1;
    this.shade.material.depthWrite = false;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -2e-4;
    this.sun.shadow.normalBias = 0.0008;
    this.sun.shadow.radius = 4;
    this.root.add(this.sun, this.sun.target, this.fill, this.fill.target, this.sky, this.base, this.grid, this.shade);
  }

  /** Sets light and floor for a product of this size on a table of this height [m]. */
  fit(centre: Vector3, radius: number, tableZ: number): void {
    const reach = 9 * radius;
    for (const mesh of [this.grid, this.shade]) {
      mesh.position.set(centre.x, centre.y, tableZ - 1e-4);
      mesh.scale.set(2 * reach, 2 * reach, 1);
    }
    const uniforms = this.grid.material.uniforms;
    uniforms["cell"]!.value = gridCell(radius);
    uniforms["reach"]!.value = reach;
    (uniforms["centre"]!.value as Vector3).copy(centre);
    this.sun.position.copy(centre).add(new Vector3(-1.6, -2.2, 4.2).multiplyScalar(radius));
    this.fill.position.copy(centre).add(new Vector3(3, 2.5, 1.2).multiplyScalar(radius));
    this.sun.target.position.copy(centre);
    this.fill.target.position.copy(centre);
    const camera = this.sun.shadow.camera;
    camera.left = camera.bottom = -3.4 * radius;
    camera.right = camera.top = 3.4 * radius;
    camera.near = 0.2 * radius;
    camera.far = 12 * radius;
    camera.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.006 * radius;
  }

  setPalette(palette: Palette): void {
    (this.grid.material.uniforms["ink"]!.value as Color).copy(palette.grid);
    this.grid.material.uniforms["strength"]!.value = palette.isDark ? 0.5 : 0.62;
    this.shade.material.opacity = palette.isDark ? 0.42 : 0.22;
    this.sky.intensity = palette.isDark ? 1.15 : 1.45;
  }

  setGridShown(isShown: boolean): void {
    this.grid.visible = isShown;
  }

  setQuality(quality: Quality, renderer: WebGLRenderer): void {
    const hasShadow = quality === "high";
    renderer.shadowMap.enabled = hasShadow;
    renderer.shadowMap.type = PCFShadowMap;
    this.sun.castShadow = hasShadow;
    this.shade.visible = hasShadow;
  }
}
