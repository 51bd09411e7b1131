/** The button that takes all forces away: in every layout, and covered by nothing. */

import { findAction } from "./actions";
import { canSteer, store, studio } from "./app_state";
import { forcesOff } from "./hand_actions";
import { t } from "./i18n";
import { Icon } from "./icons";
import { shownKey } from "./key";

export function ForcesButton() {
  const isOff = store.forcesOff.value;
  return isOff ? (
    <button
      type="button"
      class="forces-button is-off"
      data-testid="forces-on"
      disabled={!canSteer()}
      onClick={() => void studio.command({ command: "forces", off: false })}
    >
      <Icon name="play" />
      {t("action.forcesOn")}
    </button>
  ) : (
    <button type="button" class="forces-button" data-testid="forces-off" title={shownKey(findAction("forces-off")) ?? undefined} onClick={forcesOff}>
      <Icon name="stop" />
      {t("action.forcesOff")}
    </button>
  );
}
