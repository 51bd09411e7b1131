/** What the user set up stays for the next time, in this browser. */

import { effect, type Signal } from "@preact/signals";
import { isItem } from "../model/bench";
import { decodeView } from "../model/view_link";
import { studio, ui, view, type SavedView } from "./app_state";
import { language, pickLanguage } from "./i18n";

const kKey = "hvas-studio";

type Test<T> = (value: unknown) => value is T;

interface Preference {
  read(value: unknown): void;
  value(): unknown;
}

/** @param isSound  What was kept may be of an older page, or of another hand. */
function keep<T>(signal: Signal<T>, isSound: Test<T>): Preference {
  return {
    read: (value) => {
      if (isSound(value)) {
        signal.value = value;
      }
    },
    value: () => signal.value,
  };
}

const isFlag: Test<boolean> = (value): value is boolean => typeof value === "boolean";
const isNumber: Test<number> = (value): value is number => typeof value === "number" && Number.isFinite(value);
const oneOf =
  <T>(...all: readonly T[]): Test<T> =>
  (value): value is T =>
    all.includes(value as T);
const listOf =
  <T>(isOne: Test<T>): Test<readonly T[]> =>
  (value): value is readonly T[] =>
    Array.isArray(value) && value.every(isOne);
const orNull =
  <T>(isOne: Test<T>): Test<T | null> =>
  (value): value is T | null =>
    value === null || isOne(value);
const isName: Test<string> = (value): value is string => typeof value === "string" && value.length <= 40;
const isSavedView: Test<SavedView> = (value): value is SavedView => {
  const { name, product, view: link } = (value ?? {}) as Partial<SavedView>;
  return [name, product, link].every((text) => typeof text === "string") && decodeView(link ?? "") !== null;
};

const kPreferences: Record<string, Preference> = {
  theme: keep(view.theme, oneOf("dark", "light", "system")),
  language: keep(language, oneOf("en", "de")),
  muted: keep(view.isMuted, isFlag),
  singleKeys: keep(view.hasSingleKeys, isFlag),
  quality: keep(view.quality, oneOf("low", "auto", "high")),
  assists: keep(view.assists, isFlag),
  seated: keep(view.isSeated, isFlag),
  showsWorkshop: keep(view.showsWorkshop, isFlag),
  followsSteps: keep(view.followsSteps, isFlag),
  guidesFirstPart: keep(view.guidesFirstPart, isFlag),
  editsBench: keep(view.editsBench, isFlag),
  bench: keep(view.benchItems, orNull(listOf(isItem))),
  model: keep(ui.panels.model, isFlag),
  inspector: keep(ui.panels.inspector, isFlag),
  plots: keep(ui.panels.plots, isFlag),
  modelWidth: keep(ui.sizes.model, isNumber),
  inspectorWidth: keep(ui.sizes.inspector, isNumber),
  plotsHeight: keep(ui.sizes.plots, isNumber),
  userName: keep(ui.userName, isName),
  views: keep(ui.savedViews, listOf(isSavedView)),
};

function readKept(): Record<string, unknown> {
  try {
    return (JSON.parse(localStorage.getItem(kKey) ?? "{}") ?? {}) as Record<string, unknown>;
  } catch {
    return {};
  }
}

export function keepPreferences(): void {
  const isNarrow = innerWidth < 1024;
  language.value = pickLanguage(null, navigator.languages);
  for (const panel of Object.values(ui.panels)) {
    panel.value = !isNarrow;
  }
  const kept = readKept();
  for (const [name, preference] of Object.entries(kPreferences)) {
    preference.read(kept[name]);
  }
  effect(() => {
    if (studio.study.isParticipantView.value) {
      return; // A study sets up the view; what its user is used to stays as it is.
    }
    const now = Object.fromEntries(Object.entries(kPreferences).map(([name, preference]) => [name, preference.value()]));
    try {
      localStorage.setItem(kKey, JSON.stringify(now));
    } catch {
      // Private windows may have no storage: then nothing is kept.
    }
  });
}
