/** The product as a tree to look at: subassemblies, parts, and like parts gathered. */

import type { Occurrence, Scene, Subassembly } from "../protocol/messages";

export interface TreeNode {
  /** Stable between scenes of one product. */
  key: string;
  kind: "subassembly" | "group" | "part";
  name: string;
  /** The occurrences below, or the one itself. */
  occurrences: number[];
  children: TreeNode[];
  color: string | null;
}

/** So many of the same part side by side are shown as one line. */
const kGroupFrom = 3;

/** "Hex bolt 7" to "Hex bolt": what the names of like parts have in common. */
function commonName(name: string): string {
  return name.replace(/[\s_.:-]*\d+$/, "") || name;
}

function partNode(occurrence: Occurrence): TreeNode {
  return {
    key: `o${occurrence.id}`,
    kind: "part",
    name: occurrence.name,
    occurrences: [occurrence.id],
    children: [],
    color: occurrence.color,
  };
}

function partNodes(parts: readonly Occurrence[], parentKey: string): TreeNode[] {
  const byPart = new Map<number, Occurrence[]>();
  for (const part of parts) {
    byPart.set(part.part, [...(byPart.get(part.part) ?? []), part]);
  }
  const nodes: TreeNode[] = [];
  for (const [part, like] of byPart) {
    const first = like[0];
    if (first === undefined || like.length < kGroupFrom) {
      nodes.push(...like.map(partNode));
      continue;
    }
    nodes.push({
      key: `${parentKey}/p${part}`,
      kind: "group",
      name: commonName(first.name),
      occurrences: like.map((o) => o.id),
      children: like.map(partNode),
      color: first.color,
    });
  }
  return nodes;
}

export function buildTree(scene: Scene): TreeNode[] {
  const occurrences = new Map(scene.occurrences.map((o) => [o.id, o]));
  const subassemblies = new Map(scene.subassemblies.map((s) => [s.id, s]));

  const below = (sub: Subassembly): TreeNode[] => {
    const inner = sub.subassemblies.map((id) => subassemblies.get(id)).filter((s) => s !== undefined);
    const parts = sub.occurrences.map((id) => occurrences.get(id)).filter((o) => o !== undefined);
    return [...inner.map(subNode), ...partNodes(parts, `s${sub.id}`)];
  };
  const subNode = (sub: Subassembly): TreeNode => {
    const children = below(sub);
    return {
      key: `s${sub.id}`,
      kind: "subassembly",
      name: sub.name,
      occurrences: children.flatMap((c) => c.occurrences),
      children,
      color: null,
    };
  };
  const roots = scene.subassemblies.filter((s) => s.parent === null);
  const known = new Set(scene.subassemblies.flatMap((s) => s.occurrences));
  const stray = scene.occurrences.filter((o) => !known.has(o.id));
  return [...roots.flatMap(below), ...partNodes(stray, "root")];
}

/** The nodes whose name, or that of something below them, has `text` in it. */
export function filterTree(nodes: readonly TreeNode[], text: string): TreeNode[] {
  const wanted = text.trim().toLowerCase();
  if (wanted === "") {
    return [...nodes];
  }
  const kept: TreeNode[] = [];
  for (const node of nodes) {
    if (node.name.toLowerCase().includes(wanted)) {
      kept.push(node);
      continue;
    }
    const children = filterTree(node.children, text);
    if (children.length > 0) {
      kept.push({ ...node, children, occurrences: children.flatMap((c) => c.occurrences) });
    }
  }
  return kept;
}

/** The subassembly that a part stands in; where just that is selected, the next one around it, up to the
 whole product, and then the first again. */
export function groupAround(scene: Scene, occurrence: number, selected: readonly number[]): number[] {
  const subassemblies = new Map(scene.subassemblies.map((s) => [s.id, s]));
  const below = (sub: Subassembly): number[] => [
    ...sub.occurrences,
    ...sub.subassemblies.flatMap((id) => below(subassemblies.get(id)!)),
  ];
  const chosen = new Set(selected);
  const isChosen = (ids: readonly number[]) => ids.length === chosen.size && ids.every((id) => chosen.has(id));
  let at = scene.occurrences.find((o) => o.id === occurrence)?.parent ?? null;
  let ids = [occurrence];
  while (at !== null) {
    const sub = subassemblies.get(at);
    if (sub === undefined) {
      break;
    }
    const around = below(sub);
    const climbs = isChosen(around) && sub.parent !== null;
    ids = around;
    if (!climbs) {
      break;
    }
    at = sub.parent;
  }
  return ids;
}
