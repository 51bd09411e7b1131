/** What a participant of a study sees: one thing at a time, and nothing of the studio. */

import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { store, studio } from "../app_state";
import { t } from "../i18n";
import { Icon } from "../icons";
import { ViewportHost } from "../viewport_host";
import { ConsentPage } from "./consent";
import { DeclinedPage, DonePage, PausePage, ReadyPage, TrainingPage, WaitingPage } from "./pages";
import { QuestionPage } from "./question";
import { useParticipantSetup } from "./setup";
import { Task } from "./task";
import "./participant.css";

const kRefusalMs = 6000;

function Page() {
  const state = studio.study.state.value;
  if (state === null) {
    return <WaitingPage />;
  }
  switch (state.phase) {
    case "consent":
      return <ConsentPage state={state} />;
    case "training":
      return <TrainingPage state={state} />;
    case "ready":
      return <ReadyPage key={state.trial} state={state} />;
    case "question":
      return state.question === null ? null : (
        <QuestionPage key={`${state.trial}/${state.question.id}`} state={state} question={state.question} />
      );
    case "paused":
      return <PausePage state={state} />;
    case "declined":
      return <DeclinedPage />;
    case "done":
      return <DonePage state={state} />;
    default:
      return <WaitingPage />;
  }
}

/** In words of its own: those of the server are for the experimenter, and may say more than they should. */
function Refused() {
  const notice = store.notice.value;
  useEffect(() => {
    const timer = setTimeout(() => (store.notice.value = null), kRefusalMs);
    return () => clearTimeout(timer);
  }, [notice?.id]);
  const text = store.failure.value !== null ? t("study.failed") : notice?.isError ? t("study.refused") : null;
  return (
    <div class="study-refused" role="status" aria-live="polite">
      {text === null ? null : (
        <p data-testid="study-refused">
          <Icon name="warn" size={20} /> {text}
        </p>
      )}
    </div>
  );
}

/** Stands before everything, and goes by itself. */
function Lost() {
  const link = store.link.value;
  if (link !== "lost" && link !== "denied") {
    return null;
  }
  const isLost = link === "lost";
  return (
    <div class="study-lost" role="alert" data-testid="study-lost">
      <div class="study-lost-box">
        <Icon name={isLost ? "warn" : "lock"} size={44} />
        <p class="study-lead">{t(isLost ? "study.lost" : "study.denied")}</p>
        <p class="study-quiet">{t(isLost ? "study.lostHelp" : "study.deniedHelp")}</p>
      </div>
    </div>
  );
}

export default function Participant() {
  const { study } = studio;
  const wasSet = useSignal<boolean | null>(null);
  useParticipantSetup((isSet) => (wasSet.value = isSet));
  const isTask = study.isTask.value;
  const isCut = store.link.value === "lost" || store.link.value === "denied";
  const isWatched = store.role.value === "viewer";
  return (
    <>
      <div class={`study ${isTask ? "is-task" : "is-page"}`} inert={isCut} data-testid="study" data-phase={study.phase.value}>
        <div class="study-picture" inert={!isTask} aria-hidden={!isTask}>
          <ViewportHost />
        </div>
        {isTask ? <Task wasSet={wasSet} /> : <Page />}
        {isWatched ? <p class="study-watching">{t("study.watching")}</p> : null}
        <Refused />
      </div>
      <Lost />
    </>
  );
}
