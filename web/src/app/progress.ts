/** How far the assembly is, in words. */

import type { Step } from "../protocol/messages";
import { store } from "./app_state";
import { t, tn } from "./i18n";

/** A part that nothing more has to be done with. */
export function isInPlace(id: number): boolean {
  return store.placements.value.get(id) === "placed" || store.occurrences.value.get(id)?.is_base === true;
}

/** The part that moves. */
export function nameOfStep(step: Step): string {
  return store.occurrences.value.get(step.occurrence)?.name ?? "";
}

export function stepText(step: Step): string {
  const name = nameOfStep(step);
  const more = step.members.filter((id) => id !== step.occurrence).length;
  if (step.kind === "insert") {
    return more > 0 ? t("steps.insertMany", { name, n: more }) : t("steps.insert", { name });
  }
  return t(`steps.${step.kind}`, { name });
}

/** What is told behind the last step that is known. */
export function endText(): string {
  const pending = store.scene.value?.pending ?? 0;
  return pending > 0 ? tn("steps.pending", pending) : t("steps.doneAll");
}

/** The step at hand, with its number. */
export function stepTitle(): string {
  const at = store.step.value?.index ?? 0;
  const step = store.scene.value?.steps[at];
  const total = store.scene.value?.steps.length ?? 0;
  if (step === undefined) {
    return endText();
  }
  return `${at + 1}/${total} · ${stepText(step)}`;
}
