/** The workshop in the view: loaded when it is first wanted, left out where drawing is slow. */

import { Vector3, type Group, type Ray, type Sphere } from "three";
import { firstItems, keepOnBench, type BenchItem, type BenchKind } from "../model/bench";
import type { ViewState } from "../model/view_state";
import { Lifetime } from "./lifetime";
import type { Workshop } from "./workshop/workshop";

interface Place {
  centre: Vector3;
  radius: number;
  tableZ: number;
}

export class WorkshopHost {
  /** Called when it has come, gone or changed. */
  onChange: () => void = () => {};
  private workshop: Workshop | null = null;
  private isLoading = false;
  private place: Place | null = null;
  private readonly life = new Lifetime();
  /** What is dragged, and where on it the pointer took hold. */
  private dragged: { kind: BenchKind; dx: number; dy: number } | null = null;

  constructor(
    private readonly parent: Group,
    private readonly view: ViewState,
  ) {
    this.life.follow(() => {
      if (this.isWanted) {
        void this.load();
      }
      this.follow();
    });
    this.life.follow(() => {
      void view.benchItems.value;
      this.follow();
    });
  }

  dispose(): void {
    this.life.end();
    this.workshop?.dispose();
    this.workshop = null;
  }

  get isShown(): boolean {
    return this.workshop?.root.visible === true;
  }

  fit(sphere: Sphere, tableZ: number): void {
    this.place = { centre: sphere.center.clone(), radius: sphere.radius, tableZ };
    this.build();
  }

  /** The pointer takes hold of what stands on the bench, unless something is nearer. */
  press(ray: Ray, nearerThan: number): boolean {
    const hit = this.isShown ? this.workshop!.pick(ray) : null;
    const at = hit === null ? null : this.workshop!.pointOnBench(ray);
    const item = this.items.find((each) => each.kind === hit?.kind);
    if (hit === null || at === null || item === undefined || hit.distance > nearerThan) {
      return false;
    }
    this.dragged = { kind: item.kind, dx: item.x - at.x, dy: item.y - at.y };
    return true;
  }

  drag(ray: Ray): void {
    const at = this.workshop?.pointOnBench(ray) ?? null;
    const dragged = this.dragged;
    if (at !== null && dragged !== null) {
      this.change(dragged.kind, (item) => ({ ...item, x: at.x + dragged.dx, y: at.y + dragged.dy }));
    }
  }

  drop(): void {
    this.dragged = null;
  }

  /** Turns what is dragged. */
  turn(angle: number): void {
    if (this.dragged !== null) {
      this.change(this.dragged.kind, (item) => ({ ...item, turn: item.turn + angle }));
    }
  }

  /** Puts an item on the bench, or away. */
  toggle(kind: BenchKind): void {
    const kept = this.items.filter((item) => item.kind !== kind);
    const first = firstItems(this.workshop?.size ?? { x: 1, y: 1 }).filter((item) => item.kind === kind);
    this.view.benchItems.value = kept.length < this.items.length ? kept : [...kept, ...first];
  }

  change(kind: BenchKind, to: (item: BenchItem) => BenchItem): void {
    const size = this.workshop?.size;
    if (size !== undefined) {
      this.view.benchItems.value = this.items.map((item) => (item.kind === kind ? keepOnBench(to(item), size) : item));
    }
  }

  /** What stands on the bench. */
  get items(): readonly BenchItem[] {
    return this.view.benchItems.value ?? firstItems(this.workshop?.size ?? { x: 1, y: 1 });
  }

  private get isWanted(): boolean {
    return this.view.drawsWorkshop.value;
  }

  private async load(): Promise<void> {
    if (this.workshop !== null || this.isLoading) {
      return;
    }
    this.isLoading = true;
    const { Workshop: Loaded } = await import("./workshop/workshop");
    if (this.life.isOver) {
      return;
    }
    this.workshop = new Loaded();
    this.parent.add(this.workshop.root);
    this.build();
  }

  private build(): void {
    if (this.workshop !== null && this.place !== null) {
      const { centre, radius, tableZ } = this.place;
      this.workshop.fit(centre, radius, tableZ);
      this.follow();
    }
  }

  private follow(): void {
    if (this.workshop !== null) {
      this.workshop.root.visible = this.isWanted && this.place !== null;
      this.workshop.setItems(this.items);
    }
    this.onChange();
  }
}
