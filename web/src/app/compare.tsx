/** Two recordings or more, side by side: curves over one another, and a table of what each part cost. */

import { useComputed, useSignal, type Signal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import {
  depthOverTime,
  findHold,
  forceOverDepth,
  forceOverTime,
  type Against,
  type Curve,
  type ForceKind,
  type Hold,
} from "../model/compare";
import type { RecordedRun } from "../model/playback";
import { store, studio, ui } from "./app_state";
import { CompareChart, Dash, kStyles, type NamedCurve } from "./compare_chart";
import { CompareTable } from "./compare_table";
import { t } from "./i18n";
import { Icon } from "./icons";

interface Chosen {
  part: Signal<string>;
  against: Signal<Against>;
  force: Signal<ForceKind>;
}

/** The recordings that are compared, as far as they have come in, in the order in which they were chosen. */
function useRuns(): readonly RecordedRun[] {
  const loaded = useSignal<ReadonlyMap<string, RecordedRun>>(new Map());
  const ids = ui.compared.value;
  useEffect(() => {
    for (const id of ids.filter((each) => !loaded.peek().has(each))) {
      void studio.recordings.attempt(studio.recordings.fetchRun(id)).then((run) => {
        if (run === null) {
          ui.compared.value = ui.compared.peek().filter((each) => each !== id);
        } else {
          loaded.value = new Map(loaded.peek()).set(id, run);
        }
      });
    }
  }, [ids]);
  const runs = useComputed(() => ui.compared.value.flatMap((id) => loaded.value.get(id) ?? []));
  return runs.value;
}

function RecordingChips() {
  const list = store.recordings.value ?? [];
  const ids = ui.compared.value;
  const others = list.filter((entry) => !ids.includes(entry.id));
  const add = (id: string) => {
    if (id !== "") {
      ui.compared.value = [...ids, id];
    }
  };
  return (
    <>
      {ids.map((id, k) => {
        const name = list.find((entry) => entry.id === id)?.name ?? id;
        return (
          <span key={id} class="run-chip">
            <Dash style={k} />
            {name}
            <button
              type="button"
              class="eye-button"
              aria-label={t("compare.remove", { name })}
              onClick={() => (ui.compared.value = ids.filter((each) => each !== id))}
            >
              <Icon name="close" size={13} />
            </button>
          </span>
        );
      })}
      {ids.length < kStyles.length && others.length > 0 ? (
        <select
          aria-label={t("compare.add")}
          data-testid="compare-add"
          value=""
          onChange={(event) => add(event.currentTarget.value)}
        >
          <option value="">{t("compare.add")}</option>
          {others.map((entry) => (
            <option key={entry.id} value={entry.id}>
              {entry.name}
            </option>
          ))}
        </select>
      ) : null}
    </>
  );
}

function Choice<T extends string>({ name, values, chosen }: { name: string; values: readonly (readonly [T, string])[]; chosen: Signal<T> }) {
  return (
    <span class="segments is-text" role="radiogroup" aria-label={name}>
      {values.map(([value, label]) => (
        <button
          key={value}
          type="button"
          role="radio"
          aria-checked={chosen.value === value}
          onClick={() => (chosen.value = value)}
        >
          {label}
        </button>
      ))}
    </span>
  );
}

function Controls({ runs, chosen }: { runs: readonly RecordedRun[]; chosen: Chosen }) {
  const paths = [...new Set(runs.flatMap((run) => run.detail.results.map((result) => result.path)))];
  return (
    <div class="compare-bar">
      <RecordingChips />
      <span class="spacer" />
      <select
        aria-label={t("compare.part")}
        data-testid="compare-part"
        value={chosen.part.value}
        onChange={(event) => (chosen.part.value = event.currentTarget.value)}
      >
        <option value="">{t("compare.all")}</option>
        {paths.map((path) => (
          <option key={path} value={path}>
            {path}
          </option>
        ))}
      </select>
      <Choice
        name={t("compare.against")}
        values={[["time", t("compare.time")], ["depth", t("compare.depth")]]}
        chosen={chosen.against}
      />
      <Choice
        name={t("compare.force")}
        values={[["felt", t("compare.felt")], ["true", t("compare.true")]]}
        chosen={chosen.force}
      />
    </div>
  );
}

type MakeCurve = (run: RecordedRun, hold: Hold) => Curve;

function makeCurves(runs: readonly RecordedRun[], part: string, make: MakeCurve): NamedCurve[] {
  return runs.flatMap((run) => {
    const hold = findHold(run.detail, part === "" ? null : part);
    const style = ui.compared.peek().indexOf(run.detail.id);
    return hold === null || style < 0 ? [] : [{ name: run.detail.name, style, points: make(run, hold) }];
  });
}

function Curves({ runs, chosen }: { runs: readonly RecordedRun[]; chosen: Chosen }) {
  const part = chosen.part.value;
  const force = chosen.force.value;
  const isOverDepth = chosen.against.value === "depth";
  const forces = useMemo(
    () => makeCurves(runs, part, (run, hold) => (isOverDepth ? forceOverDepth : forceOverTime)(run, hold, force)),
    [runs, part, force, isOverDepth],
  );
  const depths = useMemo(() => makeCurves(runs, part, depthOverTime), [runs, part]);
  const title = t(force === "felt" ? "compare.forceFelt" : "compare.forceTrue");
  return (
    <div class="compare-charts">
      <CompareChart title={title} unitX={isOverDepth ? "mm" : "s"} unitY="N" curves={forces} />
      {isOverDepth ? null : <CompareChart title={t("plot.depth")} unitX="s" unitY="mm" curves={depths} />}
    </div>
  );
}

export default function Compare() {
  const runs = useRuns();
  const chosen: Chosen = {
    part: useSignal(""),
    against: useSignal<Against>("time"),
    force: useSignal<ForceKind>("felt"),
  };
  useEffect(() => void studio.recordings.fetchList(), []);
  return (
    <div class="compare" data-testid="compare">
      <Controls runs={runs} chosen={chosen} />
      {ui.compared.value.length === 0 ? (
        <p class="quiet">{t(store.recordings.value?.length ? "compare.choose" : "compare.none")}</p>
      ) : runs.length === 0 ? (
        <p class="quiet">{t("lazy.loading")}</p>
      ) : (
        <div class="compare-body">
          <Curves runs={runs} chosen={chosen} />
          <CompareTable runs={runs} />
        </div>
      )}
    </div>
  );
}
