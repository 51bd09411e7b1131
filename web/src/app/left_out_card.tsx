/** Parts that the program could not bring in: why, and what would let them in. */

import { useSignal } from "@preact/signals";
import { select } from "../model/view_state";
import type { GapReason, LeftOut } from "../protocol/messages";
import { canSteer, store, studio, view } from "./app_state";
import { number, t, tn } from "./i18n";

function Row({ part }: { part: LeftOut }) {
  const reason = useSignal<GapReason | null>(null);
  const isBusy = useSignal(false);
  const explain = async () => {
    isBusy.value = true;
    store.orderProgress.value = null;
    reason.value = await studio.command({ command: "explain_gap", occurrence: part.occurrence });
    isBusy.value = false;
  };
  const name = store.occurrences.value.get(part.occurrence)?.name ?? `o${part.occurrence}`;
  const answer = reason.value;
  return (
    <li>
      <button type="button" class="link-like" onClick={() => select(view, [part.occurrence], false)}>
        {name}
      </button>
      {answer === null ? (
        <p class="quiet">{part.reason}</p>
      ) : (
        answer.lines.map((line) => (
          <p class="quiet" key={line}>
            {line}
          </p>
        ))
      )}
      {answer !== null && answer.picture !== "" ? (
        <img class="reason-picture" src={answer.picture} alt={answer.picture_about} data-testid="reason-picture" />
      ) : null}
      {answer === null ? (
        <p class="card-buttons">
          <button
            type="button"
            class="small-button"
            data-testid={`explain-${part.occurrence}`}
            aria-label={t("leftOut.whyOf", { name })}
            disabled={isBusy.value || !canSteer()}
            onClick={() => void explain()}
          >
            {isBusy.value
              ? t("order.busy", { percent: number(100 * (store.orderProgress.value?.fraction ?? 0), 0) })
              : t("leftOut.why")}
          </button>
        </p>
      ) : null}
    </li>
  );
}

export function LeftOutCard() {
  const parts = store.scene.value?.left_out ?? [];
  if (parts.length === 0) {
    return null;
  }
  return (
    <section class="card-group" aria-labelledby="left-out-title" data-testid="left-out">
      <h2 id="left-out-title">{tn("leftOut.title", parts.length)}</h2>
      <ul class="left-out">
        {parts.map((part) => (
          <Row key={part.occurrence} part={part} />
        ))}
      </ul>
    </section>
  );
}
