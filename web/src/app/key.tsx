/** Keys of actions, as people read them. */

import type { Action } from "./action";
import { view } from "./app_state";
import { t } from "./i18n";

/** A letter, a digit or a sign: one is soon typed by mistake, or by software that writes what it hears. */
export const isCharacterKey = (key: string) => key.length === 1;

/** The key of an action that works now, as people read it; null: there is none. */
export function shownKey(a: Action): string | null {
  const keys = a.keys?.find((each) => view.hasSingleKeys.value || !isCharacterKey(each));
  return keys === undefined ? null : keyLabel(keys);
}

/** "ctrl+z" as people read it. */
function keyLabel(keys: string): string {
  const names: Record<string, string> = { ctrl: "Ctrl", shift: "Shift", " ": t("keys.space") };
  return keys
    .split("+")
    .map((key) => names[key] ?? key.toUpperCase())
    .join(" ");
}

/** The key of an action, where one works. */
export function Key({ of }: { of: Action }) {
  const label = shownKey(of);
  return label === null ? null : <kbd>{label}</kbd>;
}
