/** The one studio of this page, and what its parts share. */

import { effect, signal } from "@preact/signals";
import { PartPaths } from "../model/part_path";
import { Studio } from "../model/studio";
import { kDefaultWindowS, type Span } from "../model/plot_range";
import { LiveTraces } from "../model/trace";
import { makeViewState } from "../model/view_state";
import type { Viewport } from "../view3d/viewport";

export const studio = new Studio();
export const store = studio.store;
export const view = makeViewState();
export const paths = new PartPaths(studio);
export const viewport = signal<Viewport | null>(null);
/** What the hands felt in the last minutes. */
export const liveTraces = new LiveTraces();

export type Overlay =
  | { kind: "palette" }
  | { kind: "shortcuts" }
  | { kind: "recordings" }
  | { kind: "devices" }
  | { kind: "views" }
  | { kind: "share" }
  | { kind: "note" }
  | { kind: "menu"; x: number; y: number; occurrence: number | null };

/** What the one sheet of a phone shows. */
export type PhoneSheetName = "steps" | "parts" | "plots";

/** Which events are listed. */
export type EventFilter = "all" | "parts" | "alarms";

export type BottomTab = "events" | "runs" | "rates" | "compare";
/** A view under a name; of a product of this name only. */
export interface SavedView {
  name: string;
  product: string;
  /** As in a link. */
  view: string;
}

export const ui = {
  overlay: signal<Overlay | null>(null),
  panels: { model: signal(true), inspector: signal(true), plots: signal(true) },
  /** Whoever has read what the assembly came to closes it. */
  isFinishClosed: signal(false),
  eventFilter: signal<EventFilter>("all"),
  /** On a phone; null: the view is seen as a whole. */
  phoneSheet: signal<PhoneSheetName | null>(null),
  bottomTab: signal<BottomTab>("events"),
  /** Of the panels, where the user has dragged their rims; 0: as the page has them [px]. */
  sizes: { model: signal(0), inspector: signal(0), plots: signal(0) },
  savedViews: signal<readonly SavedView[]>([]),
  showsTorque: signal(false),
  plotSeconds: signal<number>(kDefaultWindowS),
  /** A stretch that is looked at in place of the newest seconds. */
  plotSpan: signal<Span | null>(null),
  /** Whose forces are plotted. */
  plotHand: signal(0),
  /** Recordings that are laid side by side. */
  compared: signal<readonly string[]>([]),
  isInVr: signal(false),
  /** As others see the user of this page; empty: not given. */
  userName: signal(""),
  /** The server knows a name of this page. */
  hasName: signal(false),
  /** What is searched in the tree. */
  treeSearch: signal(""),
  /** Asks the tree's search field to take the focus. */
  findRequest: signal(0),
};

/** In sight or not, nothing of the last minutes is missed while the page lives. */
const kFollowMs = 500;

export function followTraces(): void {
  effect(() => void (ui.plotHand.value = view.hand.value));
  setInterval(() => {
    if (studio.liveFrames !== null) {
      liveTraces.follow(studio.liveFrames);
    }
  }, kFollowMs);
}

export const canSteer = () => store.canSteer.value;

/** Whether the mouse and the keys of this page lead the hand that is chosen. */
export const leadsHand = () =>
  store.link.value === "open" && store.replay.value === null && store.ownHands.value.includes(view.hand.value);
