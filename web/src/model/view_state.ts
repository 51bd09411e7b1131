/** What this page shows and how; the server knows nothing of it. */

import { computed, signal } from "@preact/signals";
import type { FaceOf, Measurement } from "../protocol/messages";
import type { BenchItem } from "./bench";
import type { Vec3 } from "./math";
import type { SectionPlane } from "./view_link";

export type Tool = "hand" | "select" | "measure" | "mate";
export type SelectMode = "part" | "subassembly" | "face";
export type Stereo = "none" | "side" | "anaglyph";
export type Quality = "low" | "auto" | "high";
export type ThemeChoice = "dark" | "light" | "system";

export function makeViewState() {
  const quality = signal<Quality>("auto");
  const isSlow = signal(false);
  const isFast = signal(false);
  const showsWorkshop = signal(true);
  const reflects = signal(true);
  /** There is time for workshop and reflections: somebody has asked for the best picture, or the machine draws fast enough. */
  const isRich = computed(() => quality.value === "high" || (quality.value === "auto" && isFast.value && !isSlow.value));
  return {
    tool: signal<Tool>("hand"),
    /** The hand that the mouse leads where there are several. */
    hand: signal(0),
    selectMode: signal<SelectMode>("part"),
    selected: signal<readonly number[]>([]),
    selectedFace: signal<FaceOf | null>(null),
    /** Where a part was clicked last. */
    clickedAt: signal<{ occurrence: number; p_W: Vec3 } | null>(null),
    /** The mate whose card is shown, by its key, for what is selected (ids in their order, with commas). */
    /** A mate of the list that the pointer or the keys are at: its faces are lit. */
    litMate: signal<number | null>(null),
    cardMates: signal<ReadonlyMap<string, string>>(new Map()),
    hovered: signal<number | null>(null),
    hidden: signal<ReadonlySet<number>>(new Set()),
    ghosted: signal<ReadonlySet<number>>(new Set()),
    /** Faces picked so far by the tools that need two. */
    picked: signal<readonly FaceOf[]>([]),
    measurement: signal<Measurement | null>(null),
    section: signal<SectionPlane | null>(null),
    explode: signal(0),
    /** So many steps of the procedure are drawn undone, from its end; null: it is not taken apart. */
    apart: signal<number | null>(null),
    isOrthographic: signal(false),
    stereo: signal<Stereo>("none"),
    quality,
    /** The machine draws slowly: without a graphics processor, for one. */
    isSlow,
    /** It has drawn many pictures in a row quickly. */
    isFast,
    /** Shadows and workshop are drawn: as is wished, or else where the machine is fast enough. */
    isFine: computed(() => quality.value === "high" || (quality.value === "auto" && !isSlow.value)),
    reflects,
    /** Metals reflect a room. */
    hasRoomLight: computed(() => reflects.value && isRich.value),
    showsForces: signal(true),
    /** Newtons to metres of arrow; null: as fits the largest force so far. */
    locksForceScale: signal(false),
    showsEdges: signal(true),
    showsGrid: signal(true),
    /** The cube in the corner that turns the view. */
    showsCube: signal(true),
    /** Floor, walls, bench and tools around the product are wanted. */
    showsWorkshop,
    drawsWorkshop: computed(() => showsWorkshop.value && isRich.value),
    /** The eye moves to the next part and its place by itself. */
    followsSteps: signal(true),
    /** Three hints lead through the first part: until one has been put in by hand. */
    guidesFirstPart: signal(true),
    /** Somebody puts things onto the bench or away. */
    editsBench: signal(false),
    /** What stands on the bench; null: as at first. */
    benchItems: signal<readonly BenchItem[] | null>(null),
    assists: signal(true),
    letsGoWhenSeated: signal(true),
    /** In VR: the table is at the height of somebody who sits. */
    isSeated: signal(false),
    /** No motion that is not needed. */
    isCalm: signal(false),
    /** What an arrow key moves the held part by [m]; 0: some pixels of the picture. */
    keyMove: signal(0),
    /** What Q and E turn it by [rad]. */
    keyTurn: signal((5 * Math.PI) / 180),
    isMuted: signal(false),
    /** In studies, where the other sounds would tell of forces. */
    hasOnlyEndSound: signal(false),
    /** Commands may have a single letter, digit or sign for their key (WCAG 2.1.4). */
    hasSingleKeys: signal(true),
    theme: signal<ThemeChoice>("system"),
    /** As it is drawn now. */
    isDark: signal(true),
  };
}

export type ViewState = ReturnType<typeof makeViewState>;

/** `ids` added to the selection, or taken from it, or in place of it. */
export function select(view: ViewState, ids: readonly number[], isAdding: boolean): void {
  view.selectedFace.value = null;
  if (!isAdding) {
    view.selected.value = [...ids];
    return;
  }
  const before = new Set(view.selected.value);
  const hasAll = ids.every((id) => before.has(id));
  for (const id of ids) {
    if (hasAll) {
      before.delete(id);
    } else {
      before.add(id);
    }
  }
  view.selected.value = [...before];
}

export function setHidden(view: ViewState, ids: readonly number[], isHidden: boolean): void {
  const next = new Set(view.hidden.value);
  for (const id of ids) {
    if (isHidden) {
      next.add(id);
    } else {
      next.delete(id);
    }
  }
  view.hidden.value = next;
}

export function toggleGhost(view: ViewState, ids: readonly number[]): void {
  const next = new Set(view.ghosted.value);
  const hasAll = ids.every((id) => next.has(id));
  for (const id of ids) {
    if (hasAll) {
      next.delete(id);
    } else {
      next.add(id);
    }
  }
  view.ghosted.value = next;
}

/** Hides all others; a second time shows them again. */
export function isolate(view: ViewState, ids: readonly number[], all: readonly number[]): void {
  const kept = new Set(ids);
  const others = all.filter((id) => !kept.has(id));
  const isAlready = others.length > 0 && others.every((id) => view.hidden.value.has(id));
  view.hidden.value = isAlready ? new Set() : new Set(others);
}

export function showAll(view: ViewState): void {
  view.hidden.value = new Set();
  view.ghosted.value = new Set();
}

export function clearPicks(view: ViewState): void {
  view.picked.value = [];
  view.measurement.value = null;
}

/** The card of these parts is about this mate until another one is chosen. */
export function chooseCardMate(view: ViewState, parts: readonly number[], key: string): void {
  view.cardMates.value = new Map(view.cardMates.value).set(selectionKey(parts), key);
}

export function chosenCardMate(view: ViewState, parts: readonly number[]): string | null {
  return view.cardMates.value.get(selectionKey(parts)) ?? null;
}

function selectionKey(parts: readonly number[]): string {
  return [...parts].sort((a, b) => a - b).join();
}
