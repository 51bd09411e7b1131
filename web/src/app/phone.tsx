/** The studio on a phone: the view as a whole, one sheet from below, and tools in reach of a thumb. */

import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { ActionButton } from "./action_button";
import { actions, findAction, isEnabled, runAction } from "./actions";
import { store, ui, viewport, type PhoneSheetName } from "./app_state";
import { ConstraintList } from "./constraint_list";
import type { MessageKey } from "./en";
import { ForcesButton } from "./forces_button";
import { t } from "./i18n";
import { Icon, type IconName } from "./icons";
import { Inspector } from "./inspector";
import { MenuList, useOutside } from "./menu";
import { ModelTree } from "./model_tree";
import { Plots } from "./plots";
import { Timeline } from "./timeline";

const kSheets: readonly (readonly [PhoneSheetName, MessageKey, IconName])[] = [
  ["steps", "phone.steps", "list"],
  ["parts", "phone.parts", "cubes"],
  ["plots", "phone.plots", "measure"],
];

function PhoneMenu() {
  const [isOpen, setOpen] = useState(false);
  const root = useRef<HTMLElement>(null);
  useOutside(isOpen, root, () => setOpen(false));
  return (
    <nav class="menu-bar" aria-label={t("header.mainMenu")} ref={root}>
      <button
        type="button"
        class="icon-button"
        aria-label={t("header.mainMenu")}
        aria-haspopup="menu"
        aria-expanded={isOpen}
        data-testid="phone-menu"
        onClick={() => setOpen(!isOpen)}
      >
        <Icon name="menu" />
      </button>
      {isOpen ? <MenuList actions={actions} label={t("header.mainMenu")} onClose={() => setOpen(false)} /> : null}
    </nav>
  );
}

export function PhoneHeader() {
  return (
    <header class="header">
      <PhoneMenu />
      <h1 class="product-name">
        <span>{store.scene.value?.name ?? t("app.title")}</span>
      </h1>
      <span class="spacer" />
      <ActionButton id="undo" icon="undo" />
      <ForcesButton />
    </header>
  );
}

function Sheet({ name, children }: { name: PhoneSheetName; children: ComponentChildren }) {
  const label = t(kSheets.find(([each]) => each === name)![1]);
  return (
    <section class={`phone-sheet is-${name}`} aria-label={label} data-testid="phone-sheet">
      <button
        type="button"
        class="sheet-handle"
        aria-label={t("phone.close")}
        data-testid="phone-sheet-close"
        onClick={() => (ui.phoneSheet.value = null)}
      />
      {children}
    </section>
  );
}

/** What the person has opened; nothing covers the view until then. */
export function PhoneSheet() {
  switch (store.scene.value === null ? null : ui.phoneSheet.value) {
    case "steps":
      return (
        <Sheet name="steps">
          <Inspector />
        </Sheet>
      );
    case "parts":
      return (
        <Sheet name="parts">
          <ModelTree />
          <ConstraintList />
        </Sheet>
      );
    case "plots":
      return (
        <Sheet name="plots">
          <Plots />
          <Timeline />
        </Sheet>
      );
    default:
      return null;
  }
}

export function PhoneBar() {
  const open = ui.phoneSheet.value;
  useEffect(() => viewport.value?.guide.showNext(true), [open]);
  const demo = findAction("demo");
  return (
    <nav class="phone-bar" aria-label={t("header.panels")}>
      {kSheets.map(([name, label, icon]) => (
        <button
          key={name}
          type="button"
          aria-pressed={open === name}
          disabled={store.scene.value === null}
          data-testid={`phone-${name}`}
          onClick={() => (ui.phoneSheet.value = open === name ? null : name)}
        >
          <Icon name={icon} />
          <span>{t(label)}</span>
        </button>
      ))}
      <button type="button" aria-pressed={demo.isOn?.()} disabled={!isEnabled(demo)} data-testid="phone-demo" onClick={() => runAction(demo)}>
        <Icon name="play" />
        <span>{demo.label()}</span>
      </button>
    </nav>
  );
}
