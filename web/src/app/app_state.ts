/** The one studio of this page, and what its parts share. */

import { effect, signal } from "@preact/signals";
import { Studio } from "../model/studio";
import { kDefaultWindowS, type Span } from "../model/plot_range";
import { LiveTraces } from "../model/trace";
import { makeViewState, type ThemeChoice } from "../model/view_state";
import type { Viewport } from "../view3d/viewport";
import { language, pickLanguage, type Language } from "./i18n";

export const studio = new Studio();
export const store = studio.store;
export const view = makeViewState();
export const viewport = signal<Viewport | null>(null);
/** What the hands felt in the last minutes. */
export const liveTraces = new LiveTraces();

export type Overlay =
  | { kind: "palette" }
  | { kind: "shortcuts" }
  | { kind: "recordings" }
  | { kind: "devices" }
  | { kind: "menu"; x: number; y: number; occurrence: number | null };

export type BottomTab = "events" | "runs" | "rates" | "compare";

export const ui = {
  overlay: signal<Overlay | null>(null),
  panels: { model: signal(true), inspector: signal(true), plots: signal(true) },
  bottomTab: signal<BottomTab>("events"),
  showsTorque: signal(false),
  plotSeconds: signal<number>(kDefaultWindowS),
  /** A stretch that is looked at in place of the newest seconds. */
  plotSpan: signal<Span | null>(null),
  /** Whose forces are plotted. */
  plotHand: signal(0),
  /** Recordings that are laid side by side. */
  compared: signal<readonly string[]>([]),
  isInVr: signal(false),
  /** Asks the tree's search field to take the focus. */
  findRequest: signal(0),
};

const kKey = "hvas-studio";

interface Kept {
  theme: ThemeChoice;
  language: Language | null;
  muted: boolean;
  quality: "low" | "high";
  assists: boolean;
  seated: boolean;
  model: boolean;
  inspector: boolean;
  plots: boolean;
}

function readKept(): Partial<Kept> {
  try {
    return JSON.parse(localStorage.getItem(kKey) ?? "{}") as Partial<Kept>;
  } catch {
    return {};
  }
}

/** What the user set up stays for the next time. */
export function keepPreferences(): void {
  const kept = readKept();
  view.theme.value = kept.theme ?? "system";
  language.value = pickLanguage(kept.language ?? null, navigator.languages);
  view.isMuted.value = kept.muted ?? false;
  view.quality.value = kept.quality ?? "high";
  view.assists.value = kept.assists ?? true;
  view.isSeated.value = kept.seated ?? false;
  const isNarrow = innerWidth < 1024;
  ui.panels.model.value = kept.model ?? !isNarrow;
  ui.panels.inspector.value = kept.inspector ?? !isNarrow;
  ui.panels.plots.value = kept.plots ?? !isNarrow;
  effect(() => {
    const now: Kept = {
      theme: view.theme.value,
      language: language.value,
      muted: view.isMuted.value,
      quality: view.quality.value,
      assists: view.assists.value,
      seated: view.isSeated.value,
      model: ui.panels.model.value,
      inspector: ui.panels.inspector.value,
      plots: ui.panels.plots.value,
    };
    try {
      localStorage.setItem(kKey, JSON.stringify(now));
    } catch {
      // Private windows may have no storage: then nothing is kept.
    }
  });
}

/** In sight or not, nothing of the last minutes is missed while the page lives. */
const kFollowMs = 500;

export function followTraces(): void {
  setInterval(() => {
    if (studio.liveFrames !== null) {
      liveTraces.follow(studio.liveFrames);
    }
  }, kFollowMs);
}

export const canSteer = () => store.canSteer.value;
