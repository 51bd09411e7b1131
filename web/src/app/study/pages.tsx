/** The pages of a session on which there is nothing to do but to read and to go on. */

import { useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type { StudyState } from "../../protocol/messages";
import { isPointerHand } from "../../model/hands";
import { store, studio } from "../app_state";
import { number, t } from "../i18n";
import { Icon, type IconName } from "../icons";

/** A second press meant for the page before is not one for this [ms]. */
const kArmMs = 500;

interface PageProps {
  kind: string;
  title: string;
  progress?: boolean;
  icon?: IconName;
  children: ComponentChildren;
}

export function StudyPage({ kind, title, progress = false, icon, children }: PageProps) {
  const head = useRef<HTMLHeadingElement>(null);
  useEffect(() => head.current?.focus(), []);
  return (
    <main class={`study-page is-${kind}`} data-testid={`page-${kind}`}>
      <div class="study-sheet">
        {progress ? <Progress /> : null}
        {icon === undefined ? null : <Icon name={icon} size={52} />}
        <h1 tabIndex={-1} ref={head}>
          {title}
        </h1>
        {children}
      </div>
    </main>
  );
}

export function Progress() {
  const share = studio.study.progress.value;
  const state = studio.study.state.value;
  if (share === null || state === null || state.trial === null || state.trials === null) {
    return null;
  }
  const text = t("study.progress", { n: state.trial, of: state.trials });
  return (
    <div
      class="study-progress"
      role="progressbar"
      aria-label={t("study.progressLabel")}
      aria-valuemin={0}
      aria-valuemax={100}
      aria-valuenow={Math.round(100 * share)}
      aria-valuetext={`${text}, ${number(100 * share, 0)} %`}
    >
      <FilledBar share={share} />
      <span>{text}</span>
    </div>
  );
}

function FilledBar({ share }: { share: number }) {
  return (
    <span class="study-bar">
      <i style={{ transform: `scaleX(${share})` }} />
    </span>
  );
}

interface BigButtonProps {
  testId: string;
  label: string;
  onPress: () => void;
}

export function BigButton({ testId, label, onPress }: BigButtonProps) {
  const isArmed = useSignal(false);
  useEffect(() => {
    const timer = setTimeout(() => (isArmed.value = true), kArmMs);
    return () => clearTimeout(timer);
  }, []);
  const isOff = !isArmed.value || studio.study.isBusy.value || !studio.study.mayAct.value;
  return (
    <button
      type="button"
      class="study-button is-main"
      data-testid={testId}
      aria-disabled={isOff}
      onClick={() => (isOff ? undefined : onPress())}
    >
      {label}
    </button>
  );
}

export function Paragraphs({ text }: { text: string }) {
  return (
    <>
      {text
        .split(/\n\s*\n/)
        .filter((each) => each.trim() !== "")
        .map((each, k) => (
          <p key={k}>{each.trim()}</p>
        ))}
    </>
  );
}

/** How the part is moved, by what it is moved with. */
export function HandHelp({ state }: { state: StudyState }) {
  const isMouse = isPointerHand(store.hands.value, [0], 0);
  const keys =
    state.method === "picking"
      ? (["study.help.pickFaces", "study.help.look", "study.help.stop"] as const)
      : isMouse
        ? (["study.help.drag", "study.help.wheel", "study.help.turn", "study.help.fine", "study.help.look", "study.help.stop"] as const)
        : (["study.help.device", "study.help.release", "study.help.look", "study.help.stop"] as const);
  return (
    <ul class="study-help">
      {keys.map((key) => (
        <li key={key}>{t(key)}</li>
      ))}
    </ul>
  );
}

export function WaitingPage() {
  return (
    <StudyPage kind="waiting" title={t("study.welcome")}>
      <p class="study-lead">{t("study.waitForExperimenter")}</p>
    </StudyPage>
  );
}

export function TrainingPage({ state }: { state: StudyState }) {
  return (
    <StudyPage kind="training" title={t("study.training")}>
      {state.instruction ? <p class="study-instruction">{state.instruction}</p> : null}
      <p>{t("study.trainingAbout")}</p>
      <HandHelp state={state} />
      <p class="study-buttons">
        <BigButton testId="study-ready" label={t("study.trainingBegin")} onPress={() => void studio.study.ready()} />
      </p>
    </StudyPage>
  );
}

export function ReadyPage({ state }: { state: StudyState }) {
  const title = state.trial === null ? t("study.nextTrial") : t("study.trial", { n: state.trial });
  return (
    <StudyPage kind="ready" title={title} progress>
      {state.instruction ? <p class="study-instruction">{state.instruction}</p> : null}
      <p>{t("study.readyAbout")}</p>
      <p class="study-buttons">
        <BigButton testId="study-ready" label={t("study.start")} onPress={() => void studio.study.ready()} />
      </p>
      <details class="study-details">
        <summary>{t("study.howTo")}</summary>
        <HandHelp state={state} />
      </details>
    </StudyPage>
  );
}

export function PausePage({ state }: { state: StudyState }) {
  return (
    <StudyPage kind="paused" title={t("study.pause")} icon="pause" progress={state.trial !== null}>
      <p class="study-lead">{t("study.pauseAbout")}</p>
      <p>{t("study.pauseHelp")}</p>
    </StudyPage>
  );
}

export function DeclinedPage() {
  return (
    <StudyPage kind="declined" title={t("study.declined")}>
      <p class="study-lead">{t("study.declinedAbout")}</p>
    </StudyPage>
  );
}

export function DonePage({ state }: { state: StudyState }) {
  return (
    <StudyPage kind="done" title={t("study.thanks")} icon="check">
      <p class="study-lead">{t("study.doneAbout", { title: state.title })}</p>
      <p>{t("study.doneHelp")}</p>
    </StudyPage>
  );
}
