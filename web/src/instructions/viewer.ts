/** The turnable picture of work instructions: shows the animated glTF file that the page has in itself,
 * step by step. Everything it needs is in the page, so that it works from a disk or a mail. */

import {
  AmbientLight,
  AnimationMixer,
  Box3,
  DirectionalLight,
  HemisphereLight,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  Sphere,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { GLTFLoader, type GLTF } from "three/addons/loaders/GLTFLoader.js";

interface Step {
  title: string;
  /** When it begins and ends in the animation [s]. */
  start: number;
  end: number;
  /** Occurrences that come. */
  coming: number[];
}

/** What the page says to the viewer. */
interface ViewerData {
  steps: Step[];
}

const kComing = 0xf59e33; // The orange of the pictures of the steps.
const kNear = 0.01; // Nearest distance that is drawn, as a share of the product's size.

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) {
    bytes[i] = text.charCodeAt(i);
  }
  return bytes.buffer;
}

function textOf(id: string): string {
  const element = document.getElementById(id);
  if (element === null) {
    throw new Error(`the page has no element "${id}"`);
  }
  return element.textContent;
}

/** Draws the product and plays its animation; pictures are made only when something changes. */
class ProductView {
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(35, 1, 0.001, 100);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly mixer: AnimationMixer;
  private readonly own = new Map<Mesh, MeshStandardMaterial>();
  private isWanted = false;
  private playing: { until: number; last: number } | undefined;
  private time = 0;
  private readonly last: number = 0; // When the animation ends [s].

  constructor(host: HTMLElement, gltf: GLTF) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    host.append(this.renderer.domElement);
    this.scene.add(gltf.scene, new AmbientLight(0xffffff, 0.6), new HemisphereLight(0xffffff, 0x8890a0, 1.4));
    const sun = new DirectionalLight(0xffffff, 1.6);
    sun.position.set(1, 2, 1.5);
    this.scene.add(sun);
    this.mixer = new AnimationMixer(gltf.scene);
    gltf.scene.traverse((node) => {
      if (node instanceof Mesh && node.material instanceof MeshStandardMaterial) {
        this.own.set(node as Mesh, node.material);
      }
    });
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.frame(gltf.scene);
    for (const clip of gltf.animations) {
      this.mixer.clipAction(clip).play();
      this.last = Math.max(this.last, clip.duration);
    }
    this.controls.addEventListener("change", () => this.want());
    new ResizeObserver(() => this.resize(host)).observe(host);
    this.resize(host);
  }

  /** Shows the state at a time, with what comes in orange. */
  show(time: number, coming: ReadonlySet<number>): void {
    this.playing = undefined;
    this.mark(coming);
    this.at(time);
  }

  /** Plays from one time to another. */
  play(from: number, until: number, coming: ReadonlySet<number>): void {
    this.mark(coming);
    this.at(from);
    this.playing = { until, last: performance.now() };
    this.want();
  }

  private at(time: number): void {
    this.time = time;
    // An animation that has reached its end would begin again.
    this.mixer.setTime(Math.min(time, this.last * (1 - 1e-6)));
    this.want();
  }

  private mark(coming: ReadonlySet<number>): void {
    for (const [mesh, material] of this.own) {
      const marked = new MeshStandardMaterial({ color: kComing, roughness: 0.6, metalness: 0.1 });
      mesh.material = coming.has(occurrenceOf(mesh)) ? marked : material;
    }
  }

  private frame(product: Object3D): void {
    const sphere = new Box3().setFromObject(product).getBoundingSphere(new Sphere());
    const distance = sphere.radius / Math.sin(((this.camera.fov / 2) * Math.PI) / 180);
    this.camera.near = kNear * sphere.radius;
    this.camera.far = 10 * distance;
    this.camera.position.copy(sphere.center).add(new Vector3(0.55, 0.5, 0.75).normalize().multiplyScalar(distance));
    this.controls.target.copy(sphere.center);
    this.controls.update();
  }

  private resize(host: HTMLElement): void {
    const { clientWidth: width, clientHeight: height } = host;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    this.want();
  }

  private want(): void {
    if (!this.isWanted) {
      this.isWanted = true;
      requestAnimationFrame((now) => this.draw(now));
    }
  }

  private draw(now: number): void {
    this.isWanted = false;
    const playing = this.playing;
    if (playing !== undefined) {
      const time = Math.min(playing.until, this.time + Math.max(0, now - playing.last) / 1000);
      playing.last = now;
      this.playing = time < playing.until ? playing : undefined;
      this.at(time);
    }
    this.renderer.render(this.scene, this.camera);
  }
}

function occurrenceOf(node: Object3D): number {
  for (let at: Object3D | null = node; at !== null; at = at.parent) {
    const occurrence: unknown = at.userData["occurrence"];
    if (typeof occurrence === "number") {
      return occurrence;
    }
  }
  return -1;
}

/** The buttons and the slider below the picture. */
function connect(root: HTMLElement, view: ProductView, steps: readonly Step[]): void {
  const slider = root.querySelector<HTMLInputElement>("input");
  const title = root.querySelector<HTMLElement>(".viewer-title");
  const [previous, next] = root.querySelectorAll<HTMLButtonElement>("button");
  if (slider === null || title === null || previous === undefined || next === undefined) {
    throw new Error("the viewer's controls are not in the page");
  }
  let at = steps.length; // All steps done: the product is whole.
  const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const go = (to: number, plays: boolean) => {
    at = Math.max(0, Math.min(steps.length, to));
    slider.value = String(at);
    previous.disabled = at === 0;
    next.disabled = at === steps.length;
    const step = steps[at];
    title.textContent = step === undefined ? "" : step.title;
    if (step === undefined) {
      view.show((steps.at(-1)?.end ?? 0) + 1, new Set());
    } else if (plays && !isCalm) {
      view.play(step.start, step.end, new Set(step.coming));
    } else {
      view.show(step.start, new Set(step.coming));
    }
  };
  slider.max = String(steps.length);
  slider.addEventListener("input", () => go(Number(slider.value), false));
  previous.addEventListener("click", () => go(at - 1, true));
  next.addEventListener("click", () => go(at + 1, true));
  go(steps.length, false);
}

async function start(): Promise<void> {
  const root = document.getElementById("hvas-viewer");
  const host = root?.querySelector<HTMLElement>(".viewer-view");
  if (root === null || host === null || host === undefined) {
    return;
  }
  const data = JSON.parse(textOf("hvas-viewer-data")) as ViewerData;
  const gltf = await new GLTFLoader().parseAsync(bytesOf(textOf("hvas-viewer-glb")), "");
  connect(root, new ProductView(host, gltf), data.steps);
  root.hidden = false;
}

start().catch((error: unknown) => {
  // Without WebGL the pictures of the steps are there all the same.
  console.warn("The turnable picture cannot be shown:", error);
});
