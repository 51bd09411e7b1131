/** The steps of the assembly: done, at hand, to come. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { movableSteps } from "../model/order";
import { takingApart } from "../model/apart";
import { select } from "../model/view_state";
import type { Step } from "../protocol/messages";
import { canSteer, store, view } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";
import { OrderPanel } from "./order_panel";
import { endText, isInPlace, nameOfStep, stepText } from "./progress";

/** Backwards while the product is taken apart. */
function shownSteps(): { steps: readonly Step[]; at: number | null; isApart: boolean } {
  const steps = store.scene.value?.steps ?? [];
  const apart = view.apart.value;
  return apart === null
    ? { steps, at: store.step.value?.index ?? null, isApart: false }
    : { steps: takingApart(steps), at: apart, isApart: true };
}

export function Procedure() {
  const { steps, at, isApart } = shownSteps();
  const list = useRef<HTMLOListElement>(null);
  const isOrdering = useSignal(false);
  useEffect(() => {
    const now = list.current?.querySelector<HTMLElement>("[aria-current]");
    if (now && list.current) {
      // Only the list scrolls, not the panel around it.
      list.current.scrollTop = now.offsetTop - list.current.offsetTop - 52;
    }
  }, [at, steps.length]);
  const isPending = !isApart && (store.scene.value?.pending ?? 0) > 0;
  if (steps.length === 0) {
    return null;
  }
  if (isOrdering.value && !isApart) {
    return <OrderPanel key={store.scene.value?.epoch} close={() => (isOrdering.value = false)} />;
  }
  const isDone = (step: Step, k: number) =>
    (at !== null && k < at) || (!isApart && step.kind === "insert" && isInPlace(step.occurrence));
  const title = at !== null && at < steps.length ? t("steps.titleAt", { n: at + 1, total: steps.length }) : t("steps.title");
  return (
    <section class="card-group" aria-labelledby="steps-title">
      <h2 id="steps-title">{title}</h2>
      <ol class="steps" ref={list} tabIndex={0} aria-labelledby="steps-title">
        {steps.map((step, k) => {
          const isNow = k === at;
          const done = isDone(step, k);
          return (
            <li key={k} class={isNow ? "is-now" : done ? "is-done" : ""} aria-current={isNow ? "step" : undefined}>
              <button
                type="button"
                data-testid={`step-${k}`}
                onClick={() => select(view, [step.occurrence, ...step.members], false)}
              >
                <Icon name={isNow ? "play" : done ? "check" : "dot"} size={14} />
                <span>{isApart ? t("apart.next", { name: nameOfStep(step) }) : stepText(step)}</span>
                <span class="sr-only">{isNow ? t("steps.isNow") : done ? t("steps.isDone") : ""}</span>
              </button>
            </li>
          );
        })}
      </ol>
      {isApart || isPending || movableSteps(steps).length < 2 ? null : (
        <p class="card-buttons">
          <button
            type="button"
            class="small-button"
            data-testid="order-open"
            disabled={store.demo.value || !canSteer()}
            onClick={() => (isOrdering.value = true)}
          >
            {t("order.open")}
          </button>
        </p>
      )}
      {isPending || (at !== null && at >= steps.length) ? <p class="quiet">{isApart ? t("apart.done") : endText()}</p> : null}
    </section>
  );
}
