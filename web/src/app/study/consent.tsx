/** What a participant agrees to, or not. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { StudyState } from "../../protocol/messages";
import { studio } from "../app_state";
import { languageNames, t, type Language } from "../i18n";
import { BigButton, Paragraphs, StudyPage } from "./pages";

function Languages({ state }: { state: StudyState }) {
  if (state.languages.length < 2) {
    return null;
  }
  return (
    <fieldset class="study-languages">
      <legend class="sr-only">{t("status.language")}</legend>
      {state.languages.map((code) => (
        <label key={code} lang={code}>
          <input
            type="radio"
            name="language"
            checked={studio.study.language.value === code}
            disabled={!studio.study.mayAct.value}
            data-testid={`study-language-${code}`}
            onChange={() => (studio.study.chosenLanguage.value = code)}
          />
          <span>{languageNames[code as Language] ?? code}</span>
        </label>
      ))}
    </fieldset>
  );
}

function Declining({ onBack }: { onBack: () => void }) {
  const back = useRef<HTMLButtonElement>(null);
  useEffect(() => back.current?.focus(), []);
  return (
    <div class="study-confirm" role="group" aria-label={t("study.decline")} data-testid="decline-confirm">
      <p>{t("study.declineSure")}</p>
      <p class="study-buttons">
        <button type="button" class="study-button" data-testid="decline-yes" onClick={() => void studio.study.consent(false)}>
          {t("study.declineYes")}
        </button>
        <button type="button" class="study-button" data-testid="decline-no" ref={back} onClick={onBack}>
          {t("study.declineNo")}
        </button>
      </p>
    </div>
  );
}

export function ConsentPage({ state }: { state: StudyState }) {
  const spoken = studio.study.language.value ?? state.language;
  const agrees = useSignal(false);
  const isMissed = useSignal(false);
  const isDeclining = useSignal(false);
  const begin = () => {
    isMissed.value = !agrees.value;
    if (agrees.value) {
      void studio.study.consent(true);
    }
  };
  return (
    <StudyPage kind="consent" title={state.title}>
      <Languages state={state} />
      <section class="study-consent" lang={spoken} aria-label={t("study.consentText")}>
        <Paragraphs text={state.consent?.[spoken] ?? state.consent?.["en"] ?? ""} />
      </section>
      <label class="study-check">
        <input
          type="checkbox"
          checked={agrees.value}
          disabled={!studio.study.mayAct.value}
          aria-invalid={isMissed.value}
          aria-describedby={isMissed.value ? "consent-missed" : undefined}
          data-testid="consent-agree"
          onChange={(event) => {
            agrees.value = event.currentTarget.checked;
            isMissed.value &&= !agrees.value;
          }}
        />
        <span>{t("study.agree")}</span>
      </label>
      <p id="consent-missed" class="study-fault" role="alert">
        {isMissed.value ? t("study.agreeMissed") : ""}
      </p>
      {isDeclining.value ? (
        <Declining onBack={() => (isDeclining.value = false)} />
      ) : (
        <p class="study-buttons">
          <BigButton testId="consent-begin" label={t("study.begin")} onPress={begin} />
          <button type="button" class="study-button" data-testid="consent-decline" disabled={!studio.study.mayAct.value} onClick={() => (isDeclining.value = true)}>
            {t("study.decline")}
          </button>
        </p>
      )}
    </StudyPage>
  );
}
