/** While a trial or the training runs: the picture, what to do, and how to stop. */

import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { liveNumbers } from "../../model/hints";
import { isPointerHand } from "../../model/hands";
import { store, studio, view } from "../app_state";
import { ForcesButton } from "../forces_button";
import { t } from "../i18n";
import { Icon } from "../icons";
import { holdingHand, setText, useLive } from "../live";
import { clock } from "./clock";

const kTimeMs = 200;
const kGoMs = 900;
const kCaptured = 3;

function Time() {
  const text = useRef<HTMLParagraphElement>(null);
  const limit = studio.study.state.value?.limit_s ?? null;
  const isShown = studio.study.state.value?.elapsed_s != null;
  useEffect(() => {
    const show = () => {
      const elapsed = studio.study.elapsedS();
      setText(text.current, elapsed === null ? "" : limit === null ? clock(elapsed) : `${clock(elapsed)} / ${clock(limit)}`);
    };
    show();
    const timer = setInterval(show, kTimeMs);
    return () => clearInterval(timer);
  }, [limit, isShown]);
  return isShown ? <p class="task-time figures" role="timer" aria-label={t("study.time")} ref={text} data-testid="task-time" /> : null;
}

/** What the hand is to do next: no names of parts, which may tell of their fits. */
function handHint(): string {
  const held = store.held.value[0] ?? null;
  if (held === null) {
    const isMouse = isPointerHand(store.hands.value, [0], 0);
    return t(isMouse ? "study.hint.take" : "study.hint.takeDevice");
  }
  switch (held.state) {
    case "near":
      return t("study.hint.near");
    case "captured":
      return t("study.hint.captured");
    case "mating":
      return t("study.hint.mating");
    case "seated":
      return t("study.hint.seated");
    default:
      return t("study.hint.free");
  }
}

function pickHint(wasSet: boolean | null): string {
  if (view.picked.value.length === 1) {
    return t("study.hint.pickSecond");
  }
  const left = studio.study.leftToPick.value;
  const said = wasSet === false ? t("study.hint.pickWrong") : left !== null && left > 0 ? t("study.hint.pickLeft", { n: left }) : "";
  return `${said} ${t("study.hint.pickFirst")}`.trim();
}

function TaskHint({ wasSet }: { wasSet: Signal<boolean | null> }) {
  const box = useRef<HTMLDivElement>(null);
  const fill = useRef<HTMLElement>(null);
  useLive((live) => {
    const hand = holdingHand(live);
    const values = hand === null ? null : liveNumbers(hand);
    const hasDepth = values !== null && values.depthGoalMm > 0 && (hand?.state ?? 0) >= kCaptured;
    box.current?.classList.toggle("has-depth", hasDepth);
    if (hasDepth && fill.current !== null) {
      fill.current.style.transform = `scaleX(${values.depthShare})`;
    }
  }, 60);
  const isLive = studio.study.isLive.value;
  const isPicking = studio.study.isPicking.value;
  const state = !isLive ? "loading" : isPicking ? "empty" : (store.held.value[0]?.state ?? "empty");
  return (
    <div class={`task-hint is-${state}`} ref={box} data-testid="task-hint" data-state={state}>
      <i class="task-dot" aria-hidden="true" />
      <span role="status">{!isLive ? t("study.loading") : isPicking ? pickHint(wasSet.value) : handHint()}</span>
      <span class="task-depth" role="img" aria-label={t("hint.depth")}>
        <i ref={fill} />
      </span>
    </div>
  );
}

/** Until it begins, and for a moment then. */
function Go() {
  const isLive = studio.study.isLive.value;
  const isShown = useSignal(true);
  useEffect(() => {
    if (!isLive) {
      return;
    }
    const timer = setTimeout(() => (isShown.value = false), kGoMs);
    return () => clearTimeout(timer);
  }, [isLive]);
  return (
    <p class="task-go" role="status">
      {isShown.value ? <span class={isLive ? "" : "is-waiting"}>{t(isLive ? "study.go" : "study.loading")}</span> : null}
    </p>
  );
}

function ForcesAreOff() {
  if (!store.forcesOff.value) {
    return null;
  }
  return (
    <p class="task-off" role="alert" data-testid="study-forces-off">
      <Icon name="stop" size={22} /> {t("study.forcesOff")}
    </p>
  );
}

export function Task({ wasSet }: { wasSet: Signal<boolean | null> }) {
  const head = useRef<HTMLHeadingElement>(null);
  const state = studio.study.state.value;
  const key = `${state?.phase}/${state?.trial}`;
  useEffect(() => {
    head.current?.focus();
    wasSet.value = null;
  }, [key]);
  if (state === null) {
    return null;
  }
  const isTraining = state.phase === "training";
  const count =
    isTraining || state.trial === null
      ? t(isTraining ? "study.training" : "study.oneTrial")
      : state.trials === null
        ? t("study.trial", { n: state.trial })
        : t("study.progress", { n: state.trial, of: state.trials });
  return (
    <main class="task" data-testid="task">
      <header class="task-bar">
        <div class="task-words">
          <p class="task-count">{count}</p>
          <h1 tabIndex={-1} ref={head}>
            {state.instruction || t("study.doTask")}
          </h1>
          {state.condition_name ? <p class="task-count">{state.condition_name}</p> : null}
        </div>
        <Time />
        <ForcesButton />
      </header>
      <Go key={key} />
      <ForcesAreOff />
      <TaskHint wasSet={wasSet} />
    </main>
  );
}
