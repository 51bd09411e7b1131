import { store } from "./app_state";
import { duration, figures, number, t } from "./i18n";

/** What the last hold of a part cost. */
export function RunCard() {
  const run = store.runs.value[0];
  if (run === undefined) {
    return null;
  }
  const m = run.metrics;
  const rows: [string, string][] = [
    [t("run.part"), run.name],
    [t("run.result"), t(run.wasSeated ? "run.seated" : "run.dropped")],
    [t("run.time"), duration(m.time_s)],
    [t("run.path"), `${number(m.path_mm, 0)} mm`],
    [t("run.peakTrue"), `${figures(m.peak_true_n)} N`],
    [t("run.peakFelt"), `${figures(m.peak_felt_n)} N`],
    [t("run.fit"), `${figures(m.fit_true_n)} N`],
    [t("run.insertion"), `${number(m.insertion_mm, 1)} mm`],
  ];
  return (
    <section class="card-group" aria-labelledby="run-title">
      <h2 id="run-title">{t("run.title")}</h2>
      <dl class="facts" data-testid="run">
        {rows.map(([name, value]) => [<dt key={name}>{name}</dt>, <dd key={`${name}=`}>{value}</dd>])}
      </dl>
    </section>
  );
}

/** All holds so far, side by side. */
export function RunsTable() {
  const runs = store.runs.value;
  if (runs.length === 0) {
    return <p class="quiet">{t("run.none")}</p>;
  }
  return (
    <table class="runs">
      <thead>
        <tr>
          <th scope="col">{t("run.part")}</th>
          <th scope="col">{t("run.result")}</th>
          <th scope="col">s</th>
          <th scope="col">mm</th>
          <th scope="col">N</th>
        </tr>
      </thead>
      <tbody>
        {runs.map((run, k) => (
          <tr key={runs.length - k}>
            <th scope="row">{run.name}</th>
            <td>{t(run.wasSeated ? "run.seated" : "run.dropped")}</td>
            <td>{number(run.metrics.time_s, 1)}</td>
            <td>{number(run.metrics.path_mm, 0)}</td>
            <td>{figures(run.metrics.peak_true_n)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
