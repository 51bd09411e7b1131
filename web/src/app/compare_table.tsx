/** What each part cost in each recording, and how much more or less than in the first one. */

import { commonPaths, differencePercent, kMetrics, partRows, totalOf, type Metric, type Metrics } from "../model/compare";
import type { RecordedRun } from "../model/playback";
import { ui } from "./app_state";
import { Dash } from "./compare_chart";
import { saveTable } from "./exports";
import { figures, number, t } from "./i18n";
import { Icon } from "./icons";

function valueText(metric: Metric, value: number): string {
  return metric === "collisions" ? number(value, 0) : metric === "time_s" ? number(value, 1) : figures(value);
}

function Cell({ metric, value, first }: { metric: Metric; value: number | null; first: number | null }) {
  if (value === null) {
    return <td class="is-number">–</td>;
  }
  const percent = first === null ? null : differencePercent(value, first);
  const isWorse = (percent ?? 0) > 0;
  return (
    <td class="is-number">
      {valueText(metric, value)}
      {percent === null ? null : (
        <span class={`difference ${Math.abs(percent) < 0.5 ? "" : isWorse ? "is-more" : "is-less"}`}>
          {isWorse ? "+" : ""}
          {number(percent, 0)} %
        </span>
      )}
    </td>
  );
}

function Row({ name, cells }: { name: string; cells: readonly (Metrics | null)[] }) {
  return (
    <tr>
      <th scope="row">{name}</th>
      {kMetrics.flatMap((metric) =>
        cells.map((cell, k) => (
          <Cell
            key={`${metric}/${k}`}
            metric={metric}
            value={cell?.[metric] ?? null}
            first={k === 0 ? null : (cells[0]?.[metric] ?? null)}
          />
        )),
      )}
    </tr>
  );
}

function save(runs: readonly RecordedRun[]): void {
  const details = runs.map((run) => run.detail);
  const head = ["part", ...kMetrics.flatMap((metric) => details.map((detail) => `${metric} ${detail.name}`))];
  const rows = partRows(details).map(({ path, cells }) => [
    path,
    ...kMetrics.flatMap((metric) => cells.map((cell) => cell?.[metric] ?? "")),
  ]);
  saveTable([head, ...rows], "comparison");
}

/** Totals of different sets of parts say nothing of each other. */
function DifferentSets({ common, counts }: { common: number; counts: readonly number[] }) {
  return counts.every((count) => count === common) ? null : (
    <p class="note" role="note" data-testid="compare-sets">
      {common === 0 ? t("compare.nothingCommon") : t("compare.setsDiffer", { counts: counts.join(", ") })}
    </p>
  );
}

export function CompareTable({ runs }: { runs: readonly RecordedRun[] }) {
  const details = runs.map((run) => run.detail);
  const common = commonPaths(details);
  const rows = partRows(details);
  return (
    <div class="table-room" tabIndex={0} role="region" aria-label={t("compare.table")}>
      <DifferentSets common={common.size} counts={details.map((detail) => new Set(detail.results.map((each) => each.path)).size)} />
      <table class="table is-compare" data-testid="compare-table">
        <thead>
          <tr>
            <th scope="col" rowSpan={2}>
              {t("run.part")}
              <button
                type="button"
                class="icon-button is-small"
                aria-label={t("compare.csv")}
                title={t("compare.csv")}
                onClick={() => save(runs)}
              >
                <Icon name="download" size={14} />
              </button>
            </th>
            {kMetrics.map((metric) => (
              <th key={metric} scope="colgroup" colSpan={Math.max(1, details.length)}>
                {t(`compare.${metric}`)}
              </th>
            ))}
          </tr>
          <tr>
            {kMetrics.flatMap((metric) =>
              details.map((detail) => (
                <th key={`${metric}/${detail.id}`} scope="col" class="is-number" title={detail.name}>
                  <Dash style={Math.max(0, ui.compared.value.indexOf(detail.id))} />
                  <span class="sr-only">{detail.name}</span>
                </th>
              )),
            )}
          </tr>
        </thead>
        <tbody>
          {common.size === 0 ? null : (
            <Row
              name={common.size === rows.length ? t("compare.total") : t("compare.totalCommon", { n: common.size })}
              cells={details.map((detail) => totalOf(detail, common))}
            />
          )}
          {rows.map(({ path, cells }) => (
            <Row key={path} name={path.split("/").at(-1) ?? path} cells={cells} />
          ))}
        </tbody>
      </table>
    </div>
  );
}
