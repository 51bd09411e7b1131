/** The way of a part, in figures, and as a file. */

import { pathCsv, pathLength, pathTurning, type PathKind } from "../model/part_path";
import { paths, store } from "./app_state";
import { saveText, saveUrl } from "./exports";
import { number, t } from "./i18n";
import { Icon } from "./icons";

function Facts({ rows }: { rows: readonly (readonly [string, string])[] }) {
  return (
    <dl class="facts" data-testid="path-facts">
      {rows.map(([name, value]) => [<dt key={name}>{name}</dt>, <dd key={`${name}=`}>{value}</dd>])}
    </dl>
  );
}

export function PathPanel() {
  const shown = paths.shown.value;
  if (shown === null) {
    return null;
  }
  const name = store.occurrences.value.get(shown.occurrence)?.name ?? "";
  const { points, swept, kind } = shown;
  const file = `${name.replace(/[^\p{L}\p{N}]+/gu, "_")}_path`;
  return (
    <div class="float-card path-card" data-testid="path-panel">
      <h2 class="card-title">
        {t("path.title", { name })}
        <button type="button" class="icon-button is-small" aria-label={t("dialog.close")} onClick={() => paths.hide()}>
          <Icon name="close" size={14} />
        </button>
      </h2>
      <div class="segments is-wide" role="radiogroup" aria-label={t("path.as")}>
        {(["points", "swept"] as const satisfies readonly PathKind[]).map((each) => (
          <button
            key={each}
            type="button"
            role="radio"
            aria-checked={kind === each}
            onClick={() => void paths.show(shown.occurrence, each)}
          >
            {t(`path.${each}`)}
          </button>
        ))}
      </div>
      {paths.isBusy.value ? <p role="status">{t("path.busy")}</p> : null}
      {kind === "points" && points !== null ? (
        <>
          <Facts
            rows={[
              [t("path.count"), number(points.points_m.length, 0)],
              [t("path.length"), `${number(1e3 * pathLength(points.points_m), 1)} mm`],
              [t("path.turning"), `${number((pathTurning(points.poses) * 180) / Math.PI, 1)}°`],
            ]}
          />
          {points.frames_per_pose > 1 ? <p class="quiet">{t("path.thinned", { n: points.frames_per_pose })}</p> : null}
          <p class="card-buttons">
            <button type="button" class="small-button" data-testid="path-csv" onClick={() => saveText(pathCsv(points), `${file}.csv`, "text/csv")}>
              CSV
            </button>
            <button
              type="button"
              class="small-button"
              data-testid="path-json"
              onClick={() => saveText(JSON.stringify(points), `${file}.json`, "application/json")}
            >
              JSON
            </button>
          </p>
        </>
      ) : null}
      {kind === "swept" && swept !== null ? (
        <>
          <Facts
            rows={[
              [t("path.volume"), `${number(swept.volume_mm3 / 1e3, 2)} cm³`],
              [t("path.error"), `${number(swept.error_mm, 2)} mm`],
            ]}
          />
          <p class="card-buttons">
            <button type="button" class="small-button" data-testid="path-glb" onClick={() => void saveUrl(swept.glb, `${file}.glb`)}>
              GLB
            </button>
          </p>
        </>
      ) : null}
    </div>
  );
}
