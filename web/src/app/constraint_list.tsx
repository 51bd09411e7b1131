/** The mates of what is selected, or of the step at hand, with their state. */

import type { Diagnostic, Mate } from "../protocol/messages";
import { mateKey } from "../model/fit_mates";
import { chooseCardMate, select } from "../model/view_state";
import { canSteer, store, studio, view } from "./app_state";
import { number, t } from "./i18n";
import { Icon } from "./icons";
import { isInPlace } from "./progress";

const kShown = 40;

function stateOf(mate: Mate): "open" | "done" | "active" {
  if (store.held.value.some((h) => h.mate === mate.id)) {
    return "active";
  }
  return isInPlace(mate.a) && isInPlace(mate.b) ? "done" : "open";
}

/** "Concentric ⌀ 20 mm", "Slot 12 mm". */
function kindText(mate: Mate): string {
  const size = mate.fit === null ? "" : ` ${mate.kind === "axis_hole" ? "⌀\u202f" : ""}${number(mate.fit.diameter_mm)}\u202fmm`;
  return t(`mates.${mate.kind}`) + size;
}

/** The faces of a mate are lit while the pointer or the keys are at its name. */
const lights = (mate: Mate) => ({
  onMouseEnter: () => void (view.litMate.value = mate.id),
  onFocus: () => void (view.litMate.value = mate.id),
  onMouseLeave: () => void (view.litMate.value = null),
  onBlur: () => void (view.litMate.value = null),
});

/** The parts whose mates are shown: the selection, else what is held or expected; none: all mates. */
function partsInQuestion(): ReadonlySet<number> {
  const chosen = view.selected.value;
  const wanted = store.held.value[0]?.occurrence ?? store.expected.value?.occurrence;
  return new Set(chosen.length > 0 ? chosen : wanted === undefined ? [] : [wanted]);
}

/** Both parts, or the other one where it is plain whose mates these are. */
function partners(mate: Mate, of: ReadonlySet<number>): string {
  const name = (id: number) => store.occurrences.value.get(id)?.name ?? "";
  if (of.size === 1) {
    return name(of.has(mate.a) ? mate.b : mate.a);
  }
  return `${name(mate.a)} / ${name(mate.b)}`;
}

/** What mates of the user make of the poses, of the parts in question; contradictions always. */
function placementNotes(of: ReadonlySet<number>): readonly Diagnostic[] {
  const paths = new Set([...of].map((id) => store.occurrences.value.get(id)?.path));
  return (store.scene.value?.diagnostics ?? []).filter(
    ({ code, entity }) =>
      code === "mate-contradiction" || (code === "mate-freedom" && (of.size === 0 || paths.has(entity))),
  );
}

export function ConstraintList() {
  const parts = partsInQuestion();
  const all = store.scene.value?.mates ?? [];
  const mates = parts.size === 0 ? all : all.filter((m) => parts.has(m.a) || parts.has(m.b));
  return (
    <section class="constraints" aria-labelledby="constraints-title">
      <h2 id="constraints-title">
        {t("mates.title")} <span class="count">{mates.length}</span>
      </h2>
      {mates.length === 0 ? <p class="quiet">{t("mates.none")}</p> : null}
      <ul>
        {mates.slice(0, kShown).map((mate) => {
          const state = stateOf(mate);
          return (
            <li key={mateKey(mate)} class={`constraint is-${state}`}>
              <button
                type="button"
                class="constraint-name"
                title={mate.evidence}
                data-testid={`mate-${mate.id}`}
                {...lights(mate)}
                onClick={() => {
                  select(view, [mate.a, mate.b], false);
                  chooseCardMate(view, [mate.a, mate.b], mateKey(mate));
                }}
              >
                <i class="state-dot" role="img" aria-label={t(`mates.${state}`)} />
                <span class="constraint-text">
                  <span class="constraint-kind">{kindText(mate)}</span> {partners(mate, parts)}
                </span>
                {mate.fit ? <span class="badge">{mate.fit.code}</span> : null}
              </button>
              {mate.origin === "user" && canSteer() ? (
                <button
                  type="button"
                  class="eye-button"
                  aria-label={t("action.removeMate")}
                  data-testid={`remove-mate-${mate.id}`}
                  onClick={() => void studio.command({ command: "remove_mate", mate: mate.id })}
                >
                  <Icon name="close" size={14} />
                </button>
              ) : null}
            </li>
          );
        })}
      </ul>
      {placementNotes(parts).slice(0, kShown).map((note) => (
        <p class="quiet" key={`${note.code} ${note.entity} ${note.message}`} data-testid={note.code}>
          {note.code === "mate-freedom" ? `${note.entity}: ${note.message}` : note.message}
        </p>
      ))}
      {mates.length > kShown ? <p class="quiet">{t("mates.more", { n: mates.length - kShown })}</p> : null}
    </section>
  );
}
