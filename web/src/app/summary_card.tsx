/** What the assembly came to, once every part is in its place. */

import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";
import { summarizeRuns } from "../model/summary";
import { store, ui } from "./app_state";
import { findAction, runAction } from "./actions";
import { Icon } from "./icons";
import { duration, figures, number, t } from "./i18n";

/** Before everything else, until it is closed; then it is in the inspector. */
export function FinishCard() {
  const isDone = store.isDone.value;
  useEffect(() => void (ui.isFinishClosed.value = false), [isDone]);
  return ui.isFinishClosed.value || store.study.value !== null ? null : (
    <Summary className="finish-card">
      <button type="button" class="icon-button" aria-label={t("dialog.close")} data-testid="finish-close" onClick={() => (ui.isFinishClosed.value = true)}>
        <Icon name="close" />
      </button>
    </Summary>
  );
}

export function SummaryCard() {
  return ui.isFinishClosed.value ? <Summary className="card-group" /> : null;
}

function Summary({ className, children }: { className: string; children?: ComponentChildren }) {
  const runs = store.runs.value;
  if (!store.isDone.value || runs.length === 0) {
    return null;
  }
  const sum = summarizeRuns(runs);
  const rows: [string, string][] = [
    [t("summary.parts"), number(sum.parts, 0)],
    [t("summary.attempts"), number(sum.attempts, 0)],
    [t("run.time"), duration(sum.timeS)],
    [t("run.path"), `${number(sum.pathMm / 1e3, 2)} m`],
    [t("summary.collisions"), number(sum.collisions, 0)],
    [t("run.peakTrue"), `${figures(sum.peakTrueN)} N`],
    [t("run.peakFelt"), `${figures(sum.peakFeltN)} N`],
    [t("summary.slowest"), sum.slowest === null ? "–" : `${sum.slowest.name}, ${duration(sum.slowest.metrics.time_s)}`],
  ];
  return (
    <section class={className} aria-labelledby="summary-title" role="status">
      <div class="finish-head">
        <h2 id="summary-title">{t("summary.title")}</h2>
        {children}
      </div>
      <div class="card">
        <dl class="facts" data-testid="summary">
          {rows.map(([name, value]) => [<dt key={name}>{name}</dt>, <dd key={`${name}=`}>{value}</dd>])}
        </dl>
        <p class="card-buttons">
          <button type="button" class="small-button" onClick={() => runAction(findAction("runs"))}>
            CSV
          </button>
        </p>
      </div>
    </section>
  );
}
