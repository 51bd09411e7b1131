/** What is known of the selection, its fit, the procedure and the run. */

import { useRef } from "preact/hooks";
import { liveNumbers } from "../model/hints";
import { kNone } from "../protocol/frames";
import type { Occurrence } from "../protocol/messages";
import { store, view } from "./app_state";
import { FitCard } from "./fit_card";
import { number, t } from "./i18n";
import { holdingHand, setText, useLive } from "./live";
import { isInPlace } from "./progress";
import { LeftOutCard } from "./left_out_card";
import { Procedure } from "./procedure";
import { RemovalCard } from "./removal_card";
import { RunCard } from "./run_card";
import { StepsCard } from "./steps_card";
import { SummaryCard } from "./summary_card";

function massText(kg: number): string {
  return kg >= 1 ? `${number(kg, 2)} kg` : `${number(1e3 * kg, kg >= 0.01 ? 0 : 2)} g`;
}

function Selected({ part }: { part: Occurrence }) {
  const tilt = useRef<HTMLElement>(null);
  const offset = useRef<HTMLElement>(null);
  useLive((live) => {
    const hand = holdingHand(live, part.id);
    const isGuided = hand !== null && hand.occurrence === part.id && hand.mate !== kNone && hand.state >= 2;
    const values = isGuided ? liveNumbers(hand) : null;
    setText(tilt.current, values === null ? "–" : `${number(values.tiltDeg, 2)}°`);
    setText(offset.current, values === null ? "–" : `${number(values.offsetMm, 3)} mm`);
  });
  const held = store.heldBy.value.get(part.id);
  const place = held ? "held" : isInPlace(part.id) ? "placed" : (store.placements.value.get(part.id) ?? "loose");
  const state = held ? `${t("place.held")} · ${t(`state.${held.state}`)}` : t(`place.${place}`);
  const face = view.selectedFace.value;
  return (
    <section class="card-group">
      <h2>{part.name}</h2>
      <dl class="facts">
        <dt>{t("inspect.material")}</dt>
        <dd>{part.material || "–"}</dd>
        {part.number ? <dt>{t("inspect.number")}</dt> : null}
        {part.number ? <dd data-testid="selected-number">{part.number}</dd> : null}
        {part.designer ? <dt>{t("inspect.designer")}</dt> : null}
        {part.designer ? <dd>{part.designer}</dd> : null}
        <dt>{t("inspect.mass")}</dt>
        <dd>{massText(part.mass_kg)}</dd>
        <dt>{t("inspect.state")}</dt>
        <dd data-testid="selected-state">{part.is_base ? t("tree.base") : state}</dd>
        <dt>{t("inspect.tilt")}</dt>
        <dd ref={tilt} />
        <dt>{t("inspect.offset")}</dt>
        <dd ref={offset} />
        {face !== null && face.occurrence === part.id ? <dt>{t("inspect.face")}</dt> : null}
        {face !== null && face.occurrence === part.id ? <dd>{face.face}</dd> : null}
      </dl>
    </section>
  );
}

/** The held part, or else what is selected. */
export function inspected(): Occurrence | null {
  const id = store.held.value[0]?.occurrence ?? (view.selected.value.length === 1 ? view.selected.value[0] : undefined);
  return id === undefined ? null : (store.occurrences.value.get(id) ?? null);
}

export function Inspector() {
  const part = inspected();
  const count = view.selected.value.length;
  const parts = part !== null ? [part.id] : count === 2 ? view.selected.value : [];
  return (
    <aside class="inspector" aria-label={t("inspect.title")}>
      {part !== null ? (
        <Selected part={part} key={part.id} />
      ) : (
        <section class="card-group">
          <h2>{count > 1 ? t("inspect.many", { n: count }) : t("inspect.nothing")}</h2>
          {count > 1 ? null : <p class="quiet">{t("inspect.nothingHelp")}</p>}
        </section>
      )}
      {parts.length > 0 ? <FitCard parts={parts} key={`fit${parts.join()}`} /> : null}
      {part !== null && isInPlace(part.id) && !part.is_base ? <RemovalCard part={part} key={`out${part.id}`} /> : null}
      <StepsCard />
      <SummaryCard />
      <Procedure />
      <LeftOutCard />
      <RunCard />
    </aside>
  );
}
