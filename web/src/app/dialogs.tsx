/** Palette, list of shortcuts, right-click menu. */

import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { actions, findAction, isEnabled, menus, runAction } from "./actions";
import { store, ui, view } from "./app_state";
import { Dialog, DialogHead } from "./dialog";
import { t } from "./i18n";
import { Icon } from "./icons";
import { Key, shownKey } from "./key";
import { Lazy } from "./lazy";
import { MenuList, useOutside } from "./menu";

const close = () => (ui.overlay.value = null);

function Palette() {
  const text = useSignal("");
  const at = useSignal(0);
  const words = text.value.toLowerCase().split(/\s+/).filter(Boolean);
  const found = actions.filter((a) => {
    const label = a.label().toLowerCase();
    return words.every((word) => label.includes(word));
  });
  const current = Math.min(at.value, found.length - 1);
  const run = (k: number) => {
    const chosen = found[k];
    if (chosen !== undefined && isEnabled(chosen)) {
      close();
      runAction(chosen);
    }
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const moves: Record<string, number> = { ArrowDown: current + 1, ArrowUp: current - 1 };
    const to = moves[event.key];
    if (to !== undefined && found.length > 0) {
      event.preventDefault();
      at.value = (to + found.length) % found.length;
      document.getElementById(`palette-${at.value}`)?.scrollIntoView({ block: "nearest" });
    } else if (event.key === "Enter") {
      event.preventDefault();
      run(current);
    }
  };
  return (
    <Dialog title={t("palette.title")} kind="palette" onClose={close}>
      <input
        type="text"
        role="combobox"
        aria-expanded="true"
        aria-controls="palette-list"
        aria-activedescendant={`palette-${current}`}
        aria-label={t("palette.find")}
        placeholder={t("palette.find")}
        data-testid="palette-input"
        autofocus
        value={text.value}
        onInput={(event) => {
          text.value = event.currentTarget.value;
          at.value = 0;
        }}
        onKeyDown={onKeyDown}
      />
      <div class="palette-list" id="palette-list" role="listbox" aria-label={t("palette.title")}>
        {found.map((a, k) => (
          <div
            key={a.id}
            id={`palette-${k}`}
            role="option"
            aria-selected={k === current}
            aria-disabled={!isEnabled(a)}
            class="palette-row"
            onClick={() => run(k)}
            onPointerMove={() => (at.value = k)}
          >
            <span>{a.label()}</span>
            {a.isOn?.() ? <Icon name="check" size={14} /> : null}
            <Key of={a} />
          </div>
        ))}
        {found.length === 0 ? <p class="quiet">{t("palette.none")}</p> : null}
      </div>
    </Dialog>
  );
}

const kMouse = [
  ["shortcuts.dragPart", "shortcuts.dragPartDoes"],
  ["shortcuts.dragOut", "shortcuts.dragOutDoes"],
  ["shortcuts.double", "shortcuts.doubleDoes"],
  ["shortcuts.wheel", "shortcuts.wheelDoes"],
  ["shortcuts.turn", "shortcuts.turnDoes"],
  ["shortcuts.qe", "shortcuts.qeDoes"],
  ["shortcuts.arrows", "shortcuts.arrowsDoes"],
  ["shortcuts.fine", "shortcuts.fineDoes"],
  ["shortcuts.orbit", "shortcuts.orbitDoes"],
  ["shortcuts.enter", "shortcuts.enterDoes"],
  ["shortcuts.look", "shortcuts.lookDoes"],
  ["shortcuts.esc", "shortcuts.escDoes"],
] as const;

function Shortcuts() {
  return (
    <Dialog title={t("shortcuts.title")} kind="shortcuts" onClose={close}>
      <DialogHead title={t("shortcuts.title")} onClose={close} />
      <label class="shortcut-switch">
        <input
          type="checkbox"
          checked={view.hasSingleKeys.value}
          data-testid="single-keys"
          onChange={(event) => (view.hasSingleKeys.value = event.currentTarget.checked)}
        />
        {t("shortcuts.single")}
      </label>
      <div class="shortcut-columns">
        <section>
          <h3>{t("shortcuts.mouse")}</h3>
          <dl class="shortcut-list is-wide">
            {kMouse.map(([name, does]) => [<dt key={name}>{t(name)}</dt>, <dd key={does}>{t(does)}</dd>])}
          </dl>
        </section>
        {menus.map((menu) => {
          const withKeys = menu.actions.filter((a) => shownKey(a) !== null);
          return withKeys.length === 0 ? null : (
            <section key={menu.id}>
              <h3>{t(menu.id)}</h3>
              <dl class="shortcut-list">
                {withKeys.map((a) => [
                  <dt key={a.id}>
                    <Key of={a} />
                  </dt>,
                  <dd key={`${a.id}=`}>{a.label()}</dd>,
                ])}
              </dl>
            </section>
          );
        })}
      </div>
    </Dialog>
  );
}

const kOnPart = ["take", "release", "fit", "hide", "isolate", "ghost", "show-all", "path-points", "path-swept", "note", "section", "tool-measure", "tool-mate"];
const kOnFloor = ["fit", "show-all", "view-iso", "view-front", "view-top", "ortho", "section", "explode", "screenshot", "palette"];

function ContextMenu({ x, y, isOnPart }: { x: number; y: number; isOnPart: boolean }) {
  const holder = useRef<HTMLDivElement>(null);
  useOutside(true, holder, close);
  return (
    <div class="context-menu" ref={holder} data-testid="context-menu">
      <MenuList
        actions={(isOnPart ? kOnPart : kOnFloor).map(findAction)}
        label={isOnPart ? namesOfSelection() : t("menu.view")}
        onClose={close}
        x={x}
        y={y}
      />
    </div>
  );
}

function namesOfSelection(): string {
  return view.selected.value.map((id) => store.occurrences.value.get(id)?.name ?? "").join(", ");
}

export function Overlays() {
  const overlay = ui.overlay.value;
  switch (overlay?.kind) {
    case "palette":
      return <Palette />;
    case "shortcuts":
      return <Shortcuts />;
    case "recordings":
      return <Lazy key="recordings" load={() => import("./recordings_dialog")} />;
    case "views":
      return <Lazy key="views" load={() => import("./views_dialog")} />;
    case "share":
      return <Lazy key="share" load={() => import("./share_dialog")} />;
    case "note":
      return <Lazy key="note" load={() => import("./note_dialog")} />;
    case "devices":
      return <Lazy key="devices" load={() => import("./devices_dialog")} />;
    case "menu":
      return <ContextMenu x={overlay.x} y={overlay.y} isOnPart={overlay.occurrence !== null} />;
    default:
      return null;
  }
}
