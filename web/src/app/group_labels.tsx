/** Labels of groups of equal parts on the table, where a product has many parts. */

import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { groupLying, withoutOverlaps, type LyingPart, type PartGroup } from "../model/groups";
import { add, rotate } from "../model/math";
import { store, view, viewport } from "./app_state";
import { useLive } from "./live";

/** Below this number of parts each can be told from its looks, and the tree names it: a choice. */
const kManyParts = 60;

/** More would be read by nobody: a choice. */
const kMostLabels = 40;

/** Groups are looked for anew so often [ms]: a choice. */
const kGroupMs = 1000;

function listLying(): LyingPart[] {
  const product = viewport.value?.product;
  return (store.scene.value?.occurrences ?? []).flatMap(({ id, part, name }) => {
    const X_WB = product?.poseOf(id) ?? null;
    const sphere = product?.parts?.shapeOf(id)?.sphere;
    const isLying = store.placements.value.get(id) === "loose" && !view.hidden.value.has(id);
    return !isLying || X_WB === null || sphere === undefined
      ? []
      : [{ id, part, name, p_W: add(X_WB.p, rotate(X_WB.q, sphere.center.toArray())), radius: sphere.radius }];
  });
}

export function GroupLabels() {
  const groups = useSignal<readonly PartGroup[]>([]);
  const host = useRef<HTMLDivElement>(null);
  const isMany = (store.scene.value?.occurrences.length ?? 0) >= kManyParts;
  const isShown = isMany && store.study.value === null && view.explode.value === 0 && view.apart.value === null;
  useLive(() => {
    if (isShown || groups.value.length > 0) {
      groups.value = isShown ? groupLying(listLying()).slice(0, kMostLabels) : [];
    }
  }, kGroupMs);
  useLive(() => {
    const port = viewport.value;
    const labels = [...(host.current?.children ?? [])] as HTMLElement[];
    const seen = labels.map((label, i) => {
      const group = groups.value[i];
      const at = group === undefined || port === null ? null : port.project(group.p_W);
      // What lies behind the eye is nowhere in the picture.
      const place = at === null || at.isBehind ? { x: -1e6 * (i + 1), y: 0 } : at;
      return { x: place.x, y: place.y, width: label.offsetWidth + 6, height: label.offsetHeight + 4 };
    });
    const free = withoutOverlaps(seen);
    labels.forEach((label, i) => {
      label.style.visibility = free[i] === true ? "visible" : "hidden";
      label.style.transform = `translate(${seen[i]!.x.toFixed(1)}px, ${seen[i]!.y.toFixed(1)}px) translate(-50%, -50%)`;
    });
  }, 0);
  return groups.value.length === 0 ? null : (
    <div class="view-marks" ref={host} aria-hidden="true" data-testid="group-labels">
      {groups.value.map(({ name, ids }) => (
        <span key={ids[0]} class="group-label">
          {name} <b>×{ids.length}</b>
        </span>
      ))}
    </div>
  );
}
