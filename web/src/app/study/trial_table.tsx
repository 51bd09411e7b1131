/** The trials that are over, the newest first, and the mean times so far. */

import { meanTimes } from "../../model/study_summary";
import type { ExperimenterState, FinishedTrial } from "../../protocol/messages";
import { figures, number, t } from "../i18n";

function Outcome({ trial }: { trial: FinishedTrial }) {
  return <span class={`desk-outcome is-${trial.outcome}`}>{t(`desk.outcome.${trial.outcome}`)}</span>;
}

function answerText(trial: FinishedTrial): string {
  if (trial.answer === null) {
    return "–";
  }
  const mark = trial.is_right === null ? "" : trial.is_right ? " ✓" : " ✗";
  return `${trial.answer}${mark}`;
}

function Means({ state }: { state: ExperimenterState }) {
  const means = meanTimes(state.done);
  if (means.length === 0) {
    return null;
  }
  return (
    <table class="desk-table" data-testid="desk-means">
      <caption class="sr-only">{t("desk.means")}</caption>
      <thead>
        <tr>
          <th scope="col" class="is-word">{t("desk.condition")}</th>
          <th scope="col">{t("desk.count")}</th>
          <th scope="col">{t("desk.meanTime")}</th>
        </tr>
      </thead>
      <tbody>
        {means.map((each) => (
          <tr key={each.condition}>
            <th scope="row" class="is-word">{each.condition}</th>
            <td>{each.count}</td>
            <td>{each.meanS === null ? "–" : number(each.meanS, 2)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

export function TrialTable({ state }: { state: ExperimenterState }) {
  const hasAnswers = state.done.some((trial) => trial.answer !== null);
  return (
    <section class="desk-card" aria-labelledby="desk-trials-title">
      <h3 id="desk-trials-title">{t("desk.trials")}</h3>
      {state.done.length === 0 ? <p class="quiet">{t("desk.noTrials")}</p> : null}
      <Means state={state} />
      {state.done.length === 0 ? null : (
        <div class="desk-scroll" tabIndex={0} role="group" aria-labelledby="desk-trials-title">
          <table class="desk-table" data-testid="desk-trials">
            <thead>
              <tr>
                <th scope="col">{t("desk.number")}</th>
                <th scope="col" class="is-word">{t("desk.condition")}</th>
                <th scope="col">{t("desk.rep")}</th>
                <th scope="col">{t("desk.time")}</th>
                <th scope="col">{t("desk.collisions")}</th>
                <th scope="col">{t("desk.peak")}</th>
                {hasAnswers ? <th scope="col">{t("desk.answer")}</th> : null}
                <th scope="col" class="is-word">{t("run.result")}</th>
              </tr>
            </thead>
            <tbody>
              {[...state.done].reverse().map((trial) => (
                <tr key={trial.trial}>
                  <td>{trial.trial}</td>
                  <th scope="row" class="is-word">{trial.condition}</th>
                  <td>{trial.repetition}</td>
                  <td>{trial.time_s === null ? "–" : number(trial.time_s, 2)}</td>
                  <td>{trial.collisions ?? "–"}</td>
                  <td>{trial.peak_force_n === null ? "–" : figures(trial.peak_force_n)}</td>
                  {hasAnswers ? <td>{answerText(trial)}</td> : null}
                  <td class="is-word">
                    <Outcome trial={trial} />
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
    </section>
  );
}

export function Answers({ state }: { state: ExperimenterState }) {
  if (state.answers.length === 0) {
    return null;
  }
  return (
    <section class="desk-card" aria-labelledby="desk-answers">
      <h3 id="desk-answers">{t("desk.answers")}</h3>
      <dl class="facts" data-testid="desk-answers">
        {state.answers.map((answer, k) => [
          <dt key={k}>{answer.question}</dt>,
          <dd key={`${k}=`}>{answer.value ?? t("desk.noAnswer")}</dd>,
        ])}
      </dl>
    </section>
  );
}
