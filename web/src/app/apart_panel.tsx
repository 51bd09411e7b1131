/** Takes the product apart in the picture, step by step against the order of its assembly. */

import { takingApart } from "../model/apart";
import { select } from "../model/view_state";
import { store, view } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";

export function ApartPanel() {
  const count = view.apart.value;
  if (count === null) {
    return null;
  }
  const steps = takingApart(store.scene.value?.steps ?? []);
  const next = steps[count];
  const name = next === undefined ? "" : (store.occurrences.value.get(next.occurrence)?.name ?? "");
  const go = (to: number) => {
    view.apart.value = Math.min(steps.length, Math.max(0, to));
    select(view, [], false);
  };
  return (
    <div class="float-panel apart-panel" role="group" aria-label={t("action.apart")} data-testid="apart-panel">
      <button type="button" class="small-button" disabled={count === 0} data-testid="apart-back" onClick={() => go(count - 1)}>
        {t("apart.back")}
      </button>
      <input
        type="range"
        min={0}
        max={steps.length}
        step={1}
        value={count}
        aria-label={t("apart.steps")}
        aria-valuetext={t("apart.of", { n: count, total: steps.length })}
        onInput={(event) => go(Number(event.currentTarget.value))}
      />
      <span class="figures">{t("apart.of", { n: count, total: steps.length })}</span>
      <button
        type="button"
        class="small-button is-main"
        disabled={next === undefined}
        data-testid="apart-next"
        onClick={() => go(count + 1)}
      >
        {next === undefined ? t("apart.done") : t("apart.next", { name })}
      </button>
      <button type="button" class="icon-button" aria-label={t("dialog.close")} onClick={() => (view.apart.value = null)}>
        <Icon name="close" />
      </button>
    </div>
  );
}
