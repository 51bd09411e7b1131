/** The mates of what is selected, or of the step at hand, with their state. */

import type { Mate } from "../protocol/messages";
import { select } from "../model/view_state";
import { canSteer, store, studio, view } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";
import { isInPlace } from "./model_tree";

const kShown = 40;

function stateOf(mate: Mate): "open" | "done" | "active" {
  if (store.held.value.some((h) => h.mate === mate.id)) {
    return "active";
  }
  return isInPlace(mate.a) && isInPlace(mate.b) ? "done" : "open";
}

/** Of the selection; else of the expected part; else all. */
function shownMates(): readonly Mate[] {
  const mates = store.scene.value?.mates ?? [];
  const chosen = view.selected.value;
  const wanted = store.held.value[0]?.occurrence ?? store.expected.value?.occurrence;
  const ids = new Set(chosen.length > 0 ? chosen : wanted === undefined ? [] : [wanted]);
  return ids.size === 0 ? mates : mates.filter((m) => ids.has(m.a) || ids.has(m.b));
}

export function ConstraintList() {
  const names = store.occurrences.value;
  const mates = shownMates();
  return (
    <section class="constraints" aria-labelledby="constraints-title">
      <h2 id="constraints-title">
        {t("mates.title")} <span class="count">{mates.length}</span>
      </h2>
      {mates.length === 0 ? <p class="quiet">{t("mates.none")}</p> : null}
      <ul>
        {mates.slice(0, kShown).map((mate) => {
          const state = stateOf(mate);
          const a = names.get(mate.a)?.name ?? "";
          const b = names.get(mate.b)?.name ?? "";
          return (
            <li key={mate.key || mate.id} class={`constraint is-${state}`}>
              <button
                type="button"
                class="constraint-name"
                title={mate.evidence}
                data-testid={`mate-${mate.id}`}
                onClick={() => select(view, [mate.a, mate.b], false)}
              >
                <i class="state-dot" role="img" aria-label={t(`mates.${state}`)} />
                <span class="constraint-text">
                  <span class="constraint-kind">{t(`mates.${mate.kind}`)}</span> {a} / {b}
                </span>
                {mate.fit ? <span class="badge">{mate.fit.code}</span> : null}
              </button>
              {mate.origin === "user" && canSteer() ? (
                <button
                  type="button"
                  class="eye-button"
                  aria-label={t("action.removeMate")}
                  onClick={() => void studio.command({ command: "remove_mate", mate: mate.id })}
                >
                  <Icon name="close" size={14} />
                </button>
              ) : null}
            </li>
          );
        })}
      </ul>
      {mates.length > kShown ? <p class="quiet">{t("mates.more", { n: mates.length - kShown })}</p> : null}
    </section>
  );
}
