/** One thing that can be done. */

import { t } from "./i18n";
import type { MessageKey } from "./en";

export interface Action {
  id: string;
  label: () => string;
  /** As `event.key`, lower case, with "ctrl+" or "shift+" before it. */
  keys?: readonly string[];
  run: () => void;
  isEnabled?: () => boolean;
  /** Undefined: not one that can be on or off. */
  isOn?: () => boolean;
  /** A line stands before it in menus. */
  startsGroup?: boolean;
}

export function action(id: string, label: MessageKey | (() => string), run: () => void, more: Partial<Action> = {}): Action {
  return { id, label: typeof label === "function" ? label : () => t(label), run, ...more };
}

export function toggle(id: string, label: MessageKey, flag: { value: boolean }, more: Partial<Action> = {}): Action {
  return action(id, label, () => (flag.value = !flag.value), { isOn: () => flag.value, ...more });
}
