/** What begins with a view has to end with it: effects, listeners, timers, and what lies on the graphics card. */

import { effect } from "@preact/signals";
import type { BufferGeometry, Material, Mesh, Object3D, Texture } from "three";

export class Lifetime {
  private readonly ends: (() => void)[] = [];
  private hasEnded = false;

  get isOver(): boolean {
    return this.hasEnded;
  }

  /** Runs `end` at the end; what came last ends first. */
  onEnd(end: () => void): void {
    this.ends.push(end);
  }

  /** Runs as often as the signals change that it reads. */
  follow(run: () => void): void {
    this.onEnd(effect(run));
  }

  listen<E extends Event>(target: EventTarget, type: string, listener: (event: E) => void, options?: AddEventListenerOptions): void {
    const heard = listener as (event: Event) => void;
    target.addEventListener(type, heard, options);
    this.onEnd(() => target.removeEventListener(type, heard, options));
  }

  /** Runs at first, and as often as the size of the element changes. */
  followSize(element: Element, run: () => void): void {
    const observer = new ResizeObserver(run);
    observer.observe(element);
    this.onEnd(() => observer.disconnect());
  }

  repeat(periodMs: number, run: () => void): void {
    const timer = setInterval(run, periodMs);
    this.onEnd(() => clearInterval(timer));
  }

  end(): void {
    this.hasEnded = true;
    for (const end of this.ends.splice(0).reverse()) {
      end();
    }
  }
}

/** Frees the geometries of a tree, the buffers of its instances, and the maps of its shadows. Materials stay. */
export function disposeShapes(root: Object3D): void {
  root.traverse((node) => {
    const drawn = node as { geometry?: BufferGeometry; dispose?: () => void };
    drawn.geometry?.dispose();
    drawn.dispose?.();
  });
}

/** Takes a tree out of the picture and frees all that it is drawn with. */
export function disposeTree(root: Object3D): void {
  disposeShapes(root);
  root.traverse((node) => {
    for (const material of [(node as Mesh).material ?? []].flat()) {
      (material as Material & { map?: Texture | null }).map?.dispose();
      material.dispose();
    }
  });
  root.removeFromParent();
}
