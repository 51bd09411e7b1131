/** The product as a tree: an ARIA tree that the keyboard walks. */

import { useComputed, useSignal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import { buildTree, filterTree, type TreeNode } from "../model/tree";
import { select, setHidden } from "../model/view_state";
import { findAction } from "./actions";
import { store, ui, view, viewport } from "./app_state";
import { t, tn } from "./i18n";
import { Icon } from "./icons";
import { Key } from "./key";
import { isInPlace } from "./progress";

interface Row {
  node: TreeNode;
  level: number;
  isOpen: boolean;
}

function flatten(nodes: readonly TreeNode[], closed: ReadonlySet<string>, opensAll: boolean, level = 1): Row[] {
  return nodes.flatMap((node) => {
    // Groups of like parts are closed at first, subassemblies are open.
    const isOpen = node.children.length > 0 && (opensAll || closed.has(node.key) !== (node.kind !== "group"));
    return [{ node, level, isOpen }, ...(isOpen ? flatten(node.children, closed, opensAll, level + 1) : [])];
  });
}

/** What is said of a node at the end of its line, and how it is dressed. */
function badgeOf(node: TreeNode): { text: string; look: string } {
  const [first] = node.occurrences;
  if (node.kind !== "part" || first === undefined) {
    const done = node.occurrences.filter(isInPlace).length;
    const all = node.occurrences.length;
    return { text: `${done}/${all}`, look: done === all ? "is-done" : "" };
  }
  if (store.occurrences.value.get(first)?.is_base) {
    return { text: t("tree.base"), look: "is-done" };
  }
  const place = store.heldBy.value.has(first) ? "held" : (store.placements.value.get(first) ?? "loose");
  if (place !== "loose") {
    return { text: t(`place.${place}`), look: `is-${place}` };
  }
  const isNext = first === store.expected.value?.occurrence;
  return { text: isNext ? t("tree.expected") : "", look: "is-next" };
}

interface RowProps {
  row: Row;
  isActive: boolean;
  onToggle: () => void;
  onActivate: (isAdding: boolean) => void;
}

function TreeRow({ row, isActive, onToggle, onActivate }: RowProps) {
  const { node, level, isOpen } = row;
  const chosen = view.selected.value;
  const isSelected = node.occurrences.length > 0 && node.occurrences.every((id) => chosen.includes(id));
  const isHidden = node.occurrences.every((id) => view.hidden.value.has(id));
  const isHovered = node.kind === "part" && node.occurrences[0] === view.hovered.value;
  const expected = store.expected.value?.occurrence;
  const isExpected = expected !== undefined && node.occurrences.includes(expected) && !isOpen;
  const badge = badgeOf(node);
  const name = node.kind === "group" ? `${node.name} ×${node.occurrences.length}` : node.name;
  return (
    <div
      role="treeitem"
      id={`tree-${node.key}`}
      aria-level={level}
      aria-expanded={node.children.length > 0 ? isOpen : undefined}
      aria-selected={isSelected}
      aria-label={`${name} ${badge.text}`.trim()}
      data-testid={node.kind === "part" ? `part-${node.occurrences[0]}` : undefined}
      class={`tree-row ${isSelected ? "is-selected" : ""} ${isActive ? "is-active" : ""} ${isHovered ? "is-hovered" : ""} ${isHidden ? "is-hidden" : ""} ${isExpected ? "is-expected" : ""}`}
      style={{ paddingLeft: `${4 + 14 * (level - 1)}px` }}
      onClick={(event) => onActivate(event.ctrlKey || event.metaKey || event.shiftKey)}
      onDblClick={() => viewport.value?.fit(node.occurrences)}
      onPointerEnter={() => (view.hovered.value = node.kind === "part" ? (node.occurrences[0] ?? null) : null)}
      onContextMenu={(event) => {
        event.preventDefault();
        onActivate(false);
        ui.overlay.value = { kind: "menu", x: event.clientX, y: event.clientY, occurrence: node.occurrences[0] ?? null };
      }}
    >
      <span
        class={`twist ${node.children.length === 0 ? "is-leaf" : ""} ${isOpen ? "is-open" : ""}`}
        onClick={(event) => {
          event.stopPropagation();
          onToggle();
        }}
      >
        {node.children.length > 0 ? <Icon name="chevron" size={14} /> : null}
      </span>
      {node.color === null ? <Icon name="cubes" size={14} /> : <i class="swatch" style={{ background: node.color }} />}
      <span class="tree-name">{name}</span>{" "}
      {badge.text === "" ? null : <span class={`badge ${badge.look}`}>{badge.text}</span>}
      <button
        type="button"
        tabIndex={-1}
        class="eye-button"
        aria-label={t(isHidden ? "tree.show" : "tree.hide", { name })}
        onClick={(event) => {
          event.stopPropagation();
          setHidden(view, node.occurrences, !isHidden);
        }}
      >
        <Icon name={isHidden ? "eyeOff" : "eye"} size={16} />
      </button>
    </div>
  );
}

/** Arrow keys, as the ARIA tree has them. */
function walk(key: string, rows: readonly Row[], at: number): { to?: number; toggle?: boolean } {
  const row = rows[at];
  switch (key) {
    case "ArrowDown":
      return { to: Math.min(rows.length - 1, at + 1) };
    case "ArrowUp":
      return { to: Math.max(0, at - 1) };
    case "Home":
      return { to: 0 };
    case "End":
      return { to: rows.length - 1 };
    case "ArrowRight":
      return row && row.node.children.length > 0 ? (row.isOpen ? { to: at + 1 } : { toggle: true }) : {};
    case "ArrowLeft": {
      if (row?.isOpen) {
        return { toggle: true };
      }
      const parent = rows.slice(0, at).reverse().findIndex((r) => r.level < (row?.level ?? 1));
      return parent >= 0 ? { to: at - 1 - parent } : {};
    }
    default:
      return {};
  }
}

export function ModelTree() {
  const scene = store.scene.value;
  const text = ui.treeSearch;
  const closed = useSignal<ReadonlySet<string>>(new Set());
  const active = useSignal<string | null>(null);
  const search = useRef<HTMLInputElement>(null);
  const list = useRef<HTMLDivElement>(null);
  const nodes = useComputed(() => (store.scene.value === null ? [] : buildTree(store.scene.value)));
  const rows = useComputed(() => flatten(filterTree(nodes.value, text.value), closed.value, text.value.trim() !== ""));
  const request = ui.findRequest.value;
  // Before anything else is typed: what follows "/" belongs to the search.
  useLayoutEffect(() => {
    if (request > 0) {
      search.current?.focus();
    }
  }, [request]);

  const toggle = (row: Row) => {
    const next = new Set(closed.value);
    if (!next.delete(row.node.key)) {
      next.add(row.node.key);
    }
    closed.value = next;
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const at = Math.max(0, rows.value.findIndex((r) => r.node.key === active.value));
    const row = rows.value[at];
    const { to, toggle: isToggle } = walk(event.key, rows.value, at);
    if (row !== undefined && (event.key === "Enter" || event.key === " ")) {
      event.preventDefault();
      select(view, row.node.occurrences, event.ctrlKey);
    } else if (to !== undefined || isToggle) {
      event.preventDefault();
      if (row !== undefined && isToggle) {
        toggle(row);
      }
      active.value = rows.value[to ?? at]?.node.key ?? null;
      list.current?.querySelector(`[id="tree-${active.value}"]`)?.scrollIntoView({ block: "nearest" });
    }
  };
  /** Enter takes the first part that is found and brings it into the picture; the arrow goes on to the list. */
  const onSearchKey = (event: KeyboardEvent) => {
    const found = rows.value.find(({ node }) => node.children.length === 0) ?? rows.value[0];
    if (found === undefined || (event.key !== "Enter" && event.key !== "ArrowDown")) {
      return;
    }
    event.preventDefault();
    active.value = found.node.key;
    if (event.key === "Enter") {
      select(view, found.node.occurrences, false);
      viewport.value?.fit(found.node.occurrences);
    } else {
      list.current?.focus();
    }
  };
  return (
    <section class="tree-panel" aria-labelledby="tree-title">
      <h2 id="tree-title">{tn("tree.title", scene?.occurrences.length ?? 0)}</h2>
      <div class="search">
        <Icon name="search" size={15} />
        <input
          type="search"
          ref={search}
          value={text.value}
          placeholder={t("tree.find")}
          aria-label={t("tree.find")}
          data-testid="tree-search"
          onInput={(event) => (text.value = event.currentTarget.value)}
          onKeyDown={onSearchKey}
        />
        <Key of={findAction("find")} />
      </div>
      <div
        class="tree"
        role="tree"
        aria-label={t("tree.label")}
        aria-multiselectable="true"
        tabIndex={0}
        aria-activedescendant={active.value === null ? undefined : `tree-${active.value}`}
        ref={list}
        onKeyDown={onKeyDown}
        onPointerLeave={() => (view.hovered.value = null)}
      >
        {rows.value.map((row) => (
          <TreeRow
            key={row.node.key}
            row={row}
            isActive={row.node.key === active.value}
            onToggle={() => toggle(row)}
            onActivate={(isAdding) => {
              active.value = row.node.key;
              select(view, row.node.occurrences, isAdding);
            }}
          />
        ))}
        {rows.value.length === 0 ? <p class="quiet">{t("tree.nothing")}</p> : null}
      </div>
    </section>
  );
}
