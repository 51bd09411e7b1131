/** How a part in its place comes out: what has to come out first, and the simulated person who does it (X16). */

import { useSignal } from "@preact/signals";
import type { Occurrence, Removal, RemovalPlan } from "../protocol/messages";
import { canSteer, store, studio } from "./app_state";
import { number, t } from "./i18n";

function names(ids: readonly number[]): string {
  return ids.map((id) => store.occurrences.value.get(id)?.name ?? `o${id}`).join(", ");
}

function describe({ occurrences, way_mm, breakaway_n }: Removal): string {
  const way = t("removal.way", { mm: number(way_mm, 0) });
  const force = breakaway_n > 0 ? `, ${t("removal.force", { n: number(breakaway_n, 0) })}` : "";
  return `${names(occurrences)}: ${way}${force}`;
}

function Moves({ plan }: { plan: RemovalPlan }) {
  return (
    <ol class="removals" data-testid="removals">
      {plan.removals.map((removal) => (
        <li key={removal.occurrences[0]}>{describe(removal)}</li>
      ))}
    </ol>
  );
}

export function RemovalCard({ part }: { part: Occurrence }) {
  const plan = useSignal<RemovalPlan | null>(null);
  const isBusy = useSignal(false);
  const ask = async (command: "plan_removal" | "take_out") => {
    isBusy.value = true;
    const answer = await studio.command({ command, occurrence: part.id });
    isBusy.value = false;
    plan.value = answer ?? plan.value;
  };
  const isOff = isBusy.value || store.demo.value || !canSteer();
  return (
    <section class="card-group" data-testid="removal-card">
      <h2>{t("removal.title")}</h2>
      {plan.value === null ? null : <Moves plan={plan.value} />}
      {plan.value === null || plan.value.is_smallest ? null : <p class="quiet">{t("removal.notSmallest")}</p>}
      {isBusy.value ? <p role="status">{t("removal.busy")}</p> : null}
      <p class="card-buttons">
        <button type="button" class="small-button" data-testid="plan-removal" disabled={isOff} onClick={() => void ask("plan_removal")}>
          {t("removal.plan")}
        </button>
        <button type="button" class="small-button" data-testid="take-out" disabled={isOff} onClick={() => void ask("take_out")}>
          {t("removal.takeOut")}
        </button>
      </p>
    </section>
  );
}
