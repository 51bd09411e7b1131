/** How each part looks for what it is: hidden, a ghost, pointed at, selected, held, the next one. */

import { takingApart } from "../model/apart";
import type { Store } from "../model/store";
import type { ViewState } from "../model/view_state";
import { Lifetime } from "./lifetime";
import type { Palette } from "./palette";
import type { PartLook, Parts } from "./parts";

const kPulseMs = 5000;

export class PartLooks {
  private palette: Palette | null = null;
  /** What each part was given last, as text. */
  private readonly given = new Map<number, string>();
  private pulseUntil = 0;
  private readonly life = new Lifetime();

  constructor(
    private readonly store: Store,
    private readonly view: ViewState,
  ) {
    this.life.follow(() => {
      void store.step.value;
      void store.expected.value;
      this.pulseUntil = performance.now() + kPulseMs;
    });
  }

  dispose(): void {
    this.life.end();
  }

  setPalette(palette: Palette): void {
    this.palette = palette;
    this.clear();
  }

  clear(): void {
    this.given.clear();
  }

  /** For some seconds the part whose turn it is beats. @return Whether anything has changed. */
  pulse(parts: Parts): boolean {
    const beats = !this.view.isCalm.peek() && performance.now() < this.pulseUntil && this.store.expected.peek() !== null;
    return beats && this.apply(parts);
  }

  /** Depends on all the signals that it reads. @return Whether anything has changed. */
  apply(parts: Parts | null): boolean {
    const decide = this.makeDecision();
    if (parts === null || decide === null) {
      return false;
    }
    let hasChanged = false;
    for (const { occurrence } of parts.entries) {
      const look = decide(occurrence);
      const key = `${look.isHidden}${look.isGhost}${look.isMarked}${look.tint?.getHex()}${look.amount.toFixed(2)}`;
      if (this.given.get(occurrence) !== key) {
        this.given.set(occurrence, key);
        parts.setLook(occurrence, look);
        hasChanged = true;
      }
    }
    return hasChanged;
  }

  private makeDecision(): ((occurrence: number) => PartLook) | null {
    const { store, view, palette } = this;
    const selected = new Set(view.selected.value);
    const hovered = view.hovered.value;
    const hidden = view.hidden.value;
    const ghosted = view.ghosted.value;
    const held = store.heldBy.value;
    const apart = view.apart.value;
    const expected = apart === null ? store.expected.value : (takingApart(store.scene.value?.steps ?? [])[apart] ?? null);
    // In a study the part is told by its mark alone.
    const isStudied = store.study.value !== null;
    const isWanted = expected !== null && (apart !== null || ((isStudied || store.hasLease.value) && held.size === 0));
    const wanted = new Set(isWanted ? [expected.occurrence, ...expected.members] : []);
    if (palette === null) {
      return null;
    }
    const left = this.pulseUntil - performance.now();
    const steady = isStudied ? 0.6 : 0.3;
    const beat = left > 0 && !view.isCalm.value ? steady + 0.22 * Math.sin(left / 160) : steady;
    const tintOf = (id: number): Pick<PartLook, "tint" | "amount"> => {
      if (held.has(id)) {
        return { tint: palette.held, amount: 0.62 };
      }
      if (selected.has(id)) {
        return { tint: palette.selected, amount: 0.5 };
      }
      if (id === hovered) {
        return { tint: palette.hover, amount: 0.32 };
      }
      return wanted.has(id) ? { tint: palette.expected, amount: beat } : { tint: null, amount: 0 };
    };
    return (id) => ({
      isHidden: hidden.has(id),
      isGhost: ghosted.has(id),
      isMarked: selected.has(id) || id === hovered || (isStudied && wanted.has(id)),
      ...tintOf(id),
    });
  }
}
