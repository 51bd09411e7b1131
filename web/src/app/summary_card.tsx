/** What the assembly came to, once every part is in its place. */

import { summarizeRuns } from "../model/summary";
import { store } from "./app_state";
import { findAction, runAction } from "./actions";
import { duration, figures, number, t } from "./i18n";

export function SummaryCard() {
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
    <section class="card-group" aria-labelledby="summary-title" role="status">
      <h2 id="summary-title">{t("summary.title")}</h2>
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
