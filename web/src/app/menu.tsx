/** Menus of actions: under the words of the header, and at the pointer. */

import { useEffect, useRef, useState } from "preact/hooks";
import type { Action } from "./action";
import { isEnabled, menus, runAction } from "./actions";
import { t } from "./i18n";
import { Icon } from "./icons";
import { Key } from "./key";

export interface MenuListProps {
  actions: readonly Action[];
  label: string;
  onClose: () => void;
  x?: number;
  y?: number;
}

export function MenuList({ actions, label, onClose, x, y }: MenuListProps) {
  const list = useRef<HTMLDivElement>(null);
  const items = () => [...(list.current?.querySelectorAll<HTMLButtonElement>("button") ?? [])];
  useEffect(() => items()[0]?.focus(), []);
  useEffect(() => {
    const box = list.current?.getBoundingClientRect();
    if (list.current && box && x !== undefined && y !== undefined) {
      list.current.style.left = `${Math.max(4, Math.min(x, innerWidth - box.width - 8))}px`;
      list.current.style.top = `${Math.max(4, Math.min(y, innerHeight - box.height - 8))}px`;
    }
  }, [x, y]);
  const onKeyDown = (event: KeyboardEvent) => {
    const all = items();
    const at = all.indexOf(document.activeElement as HTMLButtonElement);
    const moves: Record<string, number> = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: all.length - 1 };
    const to = moves[event.key];
    if (to !== undefined) {
      event.preventDefault();
      all[(to + all.length) % all.length]?.focus();
    } else if (event.key === "Escape" || event.key === "Tab") {
      event.preventDefault();
      event.stopPropagation();
      onClose();
    }
  };
  return (
    <div class="menu" role="menu" aria-label={label} ref={list} onKeyDown={onKeyDown}>
      {actions.map((a) => (
        <button
          key={a.id}
          type="button"
          role={a.isOn ? "menuitemcheckbox" : "menuitem"}
          aria-checked={a.isOn?.()}
          aria-disabled={!isEnabled(a)}
          data-testid={`menu-${a.id}`}
          class={`menu-item ${a.startsGroup ? "starts-group" : ""}`}
          onClick={() => {
            if (isEnabled(a)) {
              onClose();
              runAction(a);
            }
          }}
        >
          <span class="menu-check">{a.isOn?.() ? <Icon name="check" size={14} /> : null}</span>
          <span class="menu-label">{a.label()}</span>
          <Key of={a} />
        </button>
      ))}
    </div>
  );
}

/** Closes when something beside it is pressed. */
export function useOutside(isOpen: boolean, root: { current: HTMLElement | null }, onClose: () => void): void {
  useEffect(() => {
    if (!isOpen) {
      return;
    }
    const onPress = (event: PointerEvent) => {
      if (!root.current?.contains(event.target as Node)) {
        onClose();
      }
    };
    addEventListener("pointerdown", onPress, true);
    return () => removeEventListener("pointerdown", onPress, true);
  }, [isOpen]);
}

export function MenuBar() {
  const [open, setOpen] = useState<string | null>(null);
  const root = useRef<HTMLElement>(null);
  const close = () => {
    const last = open;
    setOpen(null);
    root.current?.querySelector<HTMLButtonElement>(`[data-testid="${last}"]`)?.focus();
  };
  useOutside(open !== null, root, () => setOpen(null));
  return (
    <nav class="menu-bar" aria-label={t("header.mainMenu")} ref={root}>
      {menus.map((menu) => (
        <div class="menu-holder" key={menu.id}>
          <button
            type="button"
            class="menu-title"
            aria-haspopup="menu"
            aria-expanded={open === menu.id}
            data-testid={menu.id}
            onClick={() => setOpen(open === menu.id ? null : menu.id)}
            onPointerEnter={() => open !== null && setOpen(menu.id)}
          >
            {t(menu.id)}
          </button>
          {open === menu.id ? <MenuList actions={menu.actions} label={t(menu.id)} onClose={close} /> : null}
        </div>
      ))}
    </nav>
  );
}
