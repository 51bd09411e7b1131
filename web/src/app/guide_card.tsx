/** Shows how the first part is put in by hand, until one has been. */

import { useEffect, useState } from "preact/hooks";
import { countDone, dropTicked, follow, kGuideBegin, kGuideSteps, shownSteps, type GuideStep } from "../model/guide";
import { leadsHand, store, view } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";

/** A step that is done is shown with its tick for this long: a choice. */
const kTickedMs = 1500;

/** Counts the steps that the hand of this page has done since the guide was switched on. */
function useDone(isWanted: boolean): number {
  const [last, setLast] = useState<number | null>(null);
  const own = store.held.value.find((each) => store.ownHands.value.includes(each.hand)) ?? null;
  const isHolding = own !== null && own.state !== "empty";
  useEffect(() => setLast((before) => (isWanted ? null : before)), [isWanted]);
  useEffect(() => setLast((before) => (isHolding ? own.occurrence : before)), [isHolding, own?.occurrence]);
  const isPlaced = !isHolding && last !== null && store.placements.value.get(last) === "placed";
  return countDone(own?.state ?? "empty", isPlaced);
}

function words(step: GuideStep): string {
  const { scene, expected } = store;
  const id = expected.value?.occurrence ?? null;
  const part = scene.value?.occurrences.find((each) => each.id === id)?.name;
  return step === "take" && part !== undefined ? t("guide.takeExpected", { expected: part }) : t(`guide.${step}`);
}

const mayGuide = () => store.scene.value !== null && store.study.value === null && !store.demo.value && leadsHand();

/** Whether the guide says what comes next. */
export const isGuiding = () => view.guidesFirstPart.value && mayGuide();

export function GuideCard() {
  return mayGuide() ? <Guide /> : null;
}

function Guide() {
  const isWanted = view.guidesFirstPart.value;
  const done = useDone(isWanted);
  const [guidance, setGuidance] = useState(kGuideBegin);
  useEffect(() => setGuidance((before) => (isWanted ? follow(before, done) : before)), [done, isWanted]);
  useEffect(() => {
    if (isWanted && done === kGuideSteps.length) {
      view.guidesFirstPart.value = false;
    }
    const timer = setTimeout(() => setGuidance(dropTicked), kTickedMs);
    return () => clearTimeout(timer);
  }, [guidance.done]);
  const isTickedLast = guidance.done === kGuideSteps.length;
  const steps = isWanted || isTickedLast ? shownSteps(guidance) : [];
  return (
    <div role="status" aria-live="polite" aria-label={t("guide.title")} class="guide-host">
      {steps.length > 0 ? (
        <ol class="guide" data-testid="guide">
          {steps.map(({ step, number, isDone, isNext }) => (
            <li
              key={step}
              class={isDone ? "is-done" : isNext ? "is-next" : ""}
              aria-current={isNext ? "step" : undefined}
              data-testid={`guide-${step}`}
              data-done={isDone}
            >
              <span class="guide-number" aria-hidden={isDone}>
                {isDone ? <Icon name="check" size={13} /> : number}
              </span>
              {isDone ? <span class="sr-only">{t("guide.done")}</span> : null}
              <span>{words(step)}</span>
            </li>
          ))}
        </ol>
      ) : null}
    </div>
  );
}
