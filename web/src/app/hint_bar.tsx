/** What the system thinks, in words; with the depth as a bar while a part goes in. */

import { useRef } from "preact/hooks";
import { liveNumbers, makeHint } from "../model/hints";
import { leadsHand, store, studio, ui, view, viewport } from "./app_state";
import { findAction, isEnabled, runAction } from "./actions";
import { isGuiding } from "./guide_card";
import { HandOverButton } from "./hand_over";
import { number, t } from "./i18n";
import { Key } from "./key";
import { holdingHand, setText, useLive } from "./live";

export function HintBar() {
  const scene = store.scene.value;
  const bar = useRef<HTMLDivElement>(null);
  const fill = useRef<HTMLElement>(null);
  const depth = useRef<HTMLElement>(null);
  const caught = useRef<HTMLElement>(null);
  useLive((live) => {
    const hand = holdingHand(live);
    const values = hand === null ? null : liveNumbers(hand);
    const hasDepth = values !== null && values.depthGoalMm > 0 && (hand?.state ?? 0) >= 3;
    bar.current?.classList.toggle("has-depth", hasDepth);
    caught.current?.classList.toggle("is-shown", viewport.value?.hand.mouse.isCaught === true);
    if (hasDepth && fill.current !== null) {
      fill.current.style.transform = `scaleX(${values.depthShare})`;
      setText(depth.current, t("hint.of", { depth: number(values.depthMm, 1), goal: number(values.depthGoalMm, 0) }));
    }
  }, 60);
  if (scene === null) {
    return null;
  }
  const hasSeveral = store.hands.value.length > 1;
  const held = store.held.value.find((h) => h.hand === view.hand.value) ?? store.held.value[0] ?? null;
  const expected = store.expected.value?.occurrence ?? null;
  const hint = makeHint({ scene, held, expected, isDone: store.isDone.value, canSteer: leadsHand() });
  const isOthers = held !== null && leadsHand() && !store.ownHands.value.includes(held.hand);
  const mayAsk = store.role.value === "operator" && studio.study.experimenter.value === null;
  const mayLetGo = held !== null && isEnabled(findAction("release"));
  return (
    <div class={`hint-bar is-${hint.state}`} ref={bar} data-testid="hint" data-state={hint.state}>
      <i class="state-dot" aria-hidden="true" />
      <div class="hint-text">
        {hasSeveral ? <span class="badge">{t("hands.name", { n: (held?.hand ?? view.hand.value) + 1 })}</span> : null}
        <strong>{hint.params.part || t(`state.${hint.state}`)}</strong>
        {hint.params.part ? <span class="hint-state">{t(`state.${hint.state}`)}</span> : null}
        {isGuiding() && !isOthers && hint.key !== "hint.done" ? null : (
          <span class="hint-words">{isOthers ? t("hint.others") : t(hint.key, hint.params)}</span>
        )}
      </div>
      <span class="hint-caught" ref={caught}>
        {t("hint.caught")}
      </span>
      <div class="hint-depth">
        <div class="depth-bar" role="img" aria-label={t("hint.depth")}>
          <i ref={fill} />
        </div>
        <span class="figures" ref={depth} />
      </div>
      {mayLetGo ? (
        <button type="button" class="hint-button" data-testid="hint-release" onClick={() => runAction(findAction("release"))}>
          <Key of={findAction("release")} /> {t("action.release")}
        </button>
      ) : null}
      <HandOverButton />
      {!store.hasLease.value && ui.overlay.value === null && mayAsk && store.link.value === "open" ? (
        <button type="button" class="hint-button" data-testid="hint-lease" onClick={() => runAction(findAction("lease"))}>
          {t("action.lease")}
        </button>
      ) : null}
      {ui.overlay.value === null && isEnabled(findAction("join")) ? (
        <button type="button" class="hint-button" data-testid="hint-join" onClick={() => runAction(findAction("join"))}>
          {t("action.join")}
        </button>
      ) : null}
    </div>
  );
}
