/** A question to the participant: a scale, a choice, or a text. */

import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { faultOf, kIdentifyQuestion, stepsOf, type AnswerFault } from "../../model/study";
import type { AnswerValue, StudyQuestion, StudyState } from "../../protocol/messages";
import { studio } from "../app_state";
import { t } from "../i18n";
import { BigButton, StudyPage } from "./pages";

interface FieldProps {
  question: StudyQuestion;
  value: AnswerValue;
  fault: AnswerFault | null;
  onChange: (value: AnswerValue) => void;
}

/** What is read out with the number at an end of the scale. */
function endText(question: StudyQuestion, step: number): string {
  return (step === question.low ? question.low_text : step === question.high ? question.high_text : "") ?? "";
}

function ScaleField({ question, value, fault, onChange }: FieldProps) {
  return (
    <fieldset class="study-scale" aria-describedby={fault === null ? undefined : "answer-fault"}>
      <legend class="sr-only">{question.text}</legend>
      <div class="study-steps">
        {stepsOf(question).map((step) => (
          <label key={step}>
            <input
              type="radio"
              name="answer"
              checked={value === step}
              disabled={!studio.study.mayAct.value}
              data-testid={`answer-${step}`}
              onChange={() => onChange(step)}
            />
            <span>
              {step}
              {endText(question, step) === "" ? null : <span class="sr-only">: {endText(question, step)}</span>}
            </span>
          </label>
        ))}
      </div>
      <p class="study-ends" aria-hidden="true">
        <span>{question.low_text}</span>
        <span>{question.high_text}</span>
      </p>
    </fieldset>
  );
}

function ChoiceField({ question, value, fault, onChange }: FieldProps) {
  return (
    <fieldset class="study-choices" aria-describedby={fault === null ? undefined : "answer-fault"}>
      <legend class="sr-only">{question.text}</legend>
      {(question.choices ?? []).map((choice) => (
        <label key={choice.id}>
          <input
            type="radio"
            name="answer"
            checked={value === choice.id}
            disabled={!studio.study.mayAct.value}
            data-testid={`answer-${choice.id}`}
            onChange={() => onChange(choice.id)}
          />
          <span>{choice.text}</span>
        </label>
      ))}
    </fieldset>
  );
}

function TextField({ question, value, fault, onChange }: FieldProps) {
  const text = String(value ?? "");
  return (
    <>
      <textarea
        class="study-text"
        rows={6}
        value={text}
        disabled={!studio.study.mayAct.value}
        aria-label={question.text}
        aria-invalid={fault !== null}
        aria-describedby={fault === null ? undefined : "answer-fault"}
        data-testid="answer-text"
        onInput={(event) => onChange(event.currentTarget.value)}
      />
      {question.longest === undefined ? null : (
        <p class="study-quiet study-count">{t("study.characters", { n: [...text].length, of: question.longest })}</p>
      )}
    </>
  );
}

const kFields = { scale: ScaleField, choice: ChoiceField, text: TextField } as const;
const kFaults = { missing: "study.faultMissing", tooLong: "study.faultLong", unknown: "study.faultMissing" } as const;

export function QuestionPage({ state, question }: { state: StudyState; question: StudyQuestion }) {
  const value = useSignal<AnswerValue>(null);
  const fault = useSignal<AnswerFault | null>(null);
  const form = useRef<HTMLDivElement>(null);
  const Field = kFields[question.kind];
  const send = () => {
    fault.value = faultOf(question, value.value);
    if (fault.value === null) {
      void studio.study.answer(question.id, value.value);
    } else {
      form.current?.querySelector<HTMLElement>("input, textarea")?.focus();
    }
  };
  return (
    <StudyPage kind="question" title={question.text} progress={state.trial !== null}>
      <div ref={form} data-testid={`question-${question.kind}`}>
        <Field
          question={question}
          value={value.value}
          fault={fault.value}
          onChange={(next) => {
            value.value = next;
            fault.value = null;
          }}
        />
      </div>
      <p id="answer-fault" class="study-fault" role="alert">
        {fault.value === null ? "" : t(kFaults[fault.value])}
      </p>
      <p class="study-buttons">
        <BigButton testId="answer-send" label={t("study.send")} onPress={send} />
        {question.id === kIdentifyQuestion ? null : (
          <button
            type="button"
            class="study-button is-quiet"
            data-testid="answer-skip"
            disabled={!studio.study.mayAct.value || studio.study.isBusy.value}
            onClick={() => void studio.study.answer(question.id, null)}
          >
            {t("study.skip")}
          </button>
        )}
      </p>
    </StudyPage>
  );
}
