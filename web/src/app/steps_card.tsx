/** How far the keys move and turn what is in the hand. */

import { keyStep } from "./keyboard";
import { store, view } from "./app_state";
import { t } from "./i18n";
import { QuantityEntry } from "./quantity_entry";

export function StepsCard() {
  if (!store.canSteer.value || store.held.value.length === 0) {
    return null;
  }
  return (
    <section class="card-group" aria-labelledby="steps-of-keys">
      <h2 id="steps-of-keys">{t("keys.title")}</h2>
      <dl class="facts is-fields">
        <dt>{t("keys.move")}</dt>
        <dd>
          <QuantityEntry
            kind="length"
            label={t("keys.move")}
            value={keyStep()}
            digits={2}
            testId="key-move"
            onChange={(value) => (view.keyMove.value = Math.max(0, value))}
          />
        </dd>
        <dt>{t("keys.turn")}</dt>
        <dd>
          <QuantityEntry
            kind="angle"
            label={t("keys.turn")}
            value={view.keyTurn.value}
            digits={1}
            testId="key-turn"
            onChange={(value) => (view.keyTurn.value = value)}
          />
        </dd>
      </dl>
    </section>
  );
}
