/** A part goes from one hand into another, of the same person or of somebody else. */

import { followsPointer } from "../model/hands";
import { store, studio, ui, viewport } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";
import { clientName } from "./people";

const partName = (occurrence: number) => store.occurrences.value.get(occurrence)?.name ?? "";
const heldIn = (hand: number) => store.held.value.find((held) => held.hand === hand) ?? null;

/** Tells the holder that somebody would like to have the part. */
export function PartAsked() {
  const asked = store.partAsked.value;
  const held = asked === null ? null : heldIn(asked.hand);
  if (asked === null || held === null || held.occurrence !== asked.occurrence) {
    return null;
  }
  const give = () => {
    store.partAsked.value = null;
    viewport.value?.hand.passOn(asked.hand, asked.to);
  };
  return (
    <div class="banner is-info" role="alert" data-testid="part-asked">
      <Icon name="hand" />
      <span>{t("banner.partAsked", { client: clientName(asked.by), part: partName(held.occurrence) })}</span>
      <button type="button" class="banner-button" onClick={give}>
        {t("action.handOver")}
      </button>
      <button type="button" class="banner-button" onClick={() => (store.partAsked.value = null)}>
        {t("banner.keep")}
      </button>
    </div>
  );
}

async function askFor(hand: number, part: string): Promise<void> {
  if ((await studio.command({ command: "ask_part", hand })) !== null) {
    studio.notify(t("notice.partAsked", { part }));
  }
}

/** Passes the part on to the other hand, or asks for the part in it, whichever is possible. */
export function HandOverButton() {
  const own = store.ownHands.value;
  const hands = store.hands.value;
  if (hands.length < 2 || own.length === 0 || ui.overlay.value !== null || store.demo.value || store.study.value !== null) {
    return null;
  }
  const pointers = hands.map((each) => each.hand).filter((hand) => followsPointer(hands, hand));
  const holding = pointers.filter((hand) => heldIn(hand) !== null);
  const free = pointers.filter((hand) => heldIn(hand) === null);
  const isOwn = (hand: number) => own.includes(hand);
  const from = holding.find(isOwn) ?? holding[0];
  // Rather to somebody else than into the other hand of the same user.
  const to = from === undefined || !isOwn(from) ? free.find(isOwn) : (free.find((hand) => !isOwn(hand)) ?? free[0]);
  if (from === undefined || to === undefined) {
    return null;
  }
  if (own.includes(from)) {
    return (
      <button type="button" class="hint-button" data-testid="hand-over" onClick={() => viewport.value?.hand.passOn(from, to)}>
        {t("action.handOverTo", { n: to + 1 })}
      </button>
    );
  }
  const part = partName(heldIn(from)!.occurrence);
  return (
    <>
      <button type="button" class="hint-button" data-testid="ask-part" onClick={() => void askFor(from, part)}>
        {t("action.askPart", { part })}
      </button>
      <button type="button" class="hint-button" data-testid="hold-together" onClick={() => void viewport.value?.hand.holdTogether(to, from)}>
        {t("action.holdTogether")}
      </button>
    </>
  );
}
