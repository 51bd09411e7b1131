/** As much of a browser as a view needs, which counts what the view begins and does not end. */

import type { Camera, Material, Object3D, Scene, Texture } from "three";

type Disposable = Pick<Texture, "addEventListener">;

/** What lies on the graphics card: it comes when it is drawn, and goes when it is disposed of. */
class Memory {
  readonly kept = new Set<Disposable>();

  see(thing: Disposable): void {
    if (!this.kept.has(thing)) {
      this.kept.add(thing);
      const forget = () => void this.kept.delete(thing);
      thing.addEventListener("dispose", forget);
    }
  }

  /** All that a tree is drawn with, as the renderer of three finds it. */
  seeTree(root: Object3D): void {
    root.traverseVisible((node) => {
      const drawn = node as { geometry?: Disposable; material?: Material | Material[]; isInstancedMesh?: boolean };
      for (const material of [drawn.material ?? []].flat()) {
        this.see(material);
        texturesOf(material).forEach((texture) => this.see(texture));
      }
      if (drawn.geometry !== undefined) {
        this.see(drawn.geometry);
      }
      if (drawn.isInstancedMesh) {
        this.see(node as unknown as Disposable);
      }
    });
  }
}

function texturesOf(material: Material): Texture[] {
  const { map, uniforms } = material as { map?: Texture | null; uniforms?: Record<string, { value: unknown }> };
  const values = [map, ...Object.values(uniforms ?? {}).map((uniform) => uniform.value)];
  return values.filter((value): value is Texture => (value as Texture | null | undefined)?.isTexture === true);
}

export const memory = new Memory();
/** Listeners and observers that have not been taken away, and timers that run. */
export const begun = new Set<string>();
let names = 0;
const known = new WeakMap<object, number>();

function nameOf(thing: object): number {
  const name = known.get(thing) ?? ++names;
  known.set(thing, name);
  return name;
}

class FakeElement extends EventTarget {
  readonly style: Record<string, string> = {};
  readonly clientWidth = 800;
  readonly clientHeight = 600;
  width = 800;
  height = 600;
  hidden = false;

  get ownerDocument(): FakeElement {
    return page;
  }

  override addEventListener(type: string, listener: EventListener | null, options?: AddEventListenerOptions | boolean): void {
    super.addEventListener(type, listener, options);
    begun.add(this.keyOf(type, listener));
  }

  override removeEventListener(type: string, listener: EventListener | null, options?: EventListenerOptions | boolean): void {
    super.removeEventListener(type, listener, options);
    begun.delete(this.keyOf(type, listener));
  }

  createElement(): FakeElement {
    return new FakeElement();
  }

  getBoundingClientRect(): object {
    return { left: 0, top: 0, width: this.width, height: this.height };
  }

  /** Draws nothing, whatever is asked of it. */
  getContext(): object {
    const gradient = { addColorStop: () => {} };
    return new Proxy({}, { get: () => () => gradient, set: () => true });
  }

  append(): void {}
  remove(): void {}
  setAttribute(): void {}
  removeAttribute(): void {}

  private keyOf(type: string, listener: EventListener | null): string {
    return `${type} ${nameOf(this)} ${listener === null ? "" : nameOf(listener)}`;
  }
}

const page = new FakeElement();

class FakeObserver {
  observe(): void {
    begun.add(`observer ${nameOf(this)}`);
  }

  disconnect(): void {
    begun.delete(`observer ${nameOf(this)}`);
  }
}

/** In place of three's, which needs a graphics card. */
export class FakeRenderer {
  readonly xr = { isPresenting: false, getSession: () => null };
  readonly shadowMap = {};
  private loop: ((now: number) => void) | null = null;

  setAnimationLoop(loop: ((now: number) => void) | null): void {
    this.loop = loop;
    const key = `animation ${nameOf(this)}`;
    if (loop === null) {
      begun.delete(key);
    } else {
      begun.add(key);
    }
  }

  /** Draws a picture, as the browser would. */
  step(now: number): void {
    this.loop?.(now);
  }

  render(scene: Scene, camera: Camera): void {
    camera.updateMatrixWorld();
    memory.seeTree(scene);
  }

  getViewport(target: object): object {
    return target;
  }

  setClearColor(): void {}
  setPixelRatio(): void {}
  setSize(): void {}
  setViewport(): void {}
  clear(): void {}
  clearDepth(): void {}
  clearStencil(): void {}
  dispose(): void {}
  forceContextLoss(): void {}
}

/** Puts the fakes where a page finds its browser. */
export function installBrowser(): HTMLElement {
  const { setInterval: begin, clearInterval: end } = globalThis;
  Object.assign(globalThis, {
    document: page,
    devicePixelRatio: 1,
    DOMRect: class {},
    ResizeObserver: FakeObserver,
    getComputedStyle: () => ({ getPropertyValue: () => "" }),
    setInterval: (run: () => void, ms: number) => {
      const timer = begin(run, ms);
      begun.add(`timer ${nameOf(timer)}`);
      return timer;
    },
    clearInterval: (timer: NodeJS.Timeout) => {
      end(timer);
      begun.delete(`timer ${nameOf(timer)}`);
    },
  });
  return new FakeElement() as unknown as HTMLElement;
}
