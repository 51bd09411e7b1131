/** The fit of the part that is inspected: limits, the size that was drawn, and its forces. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { canHaveFit, firstMate, isFitCode, mateKey, matesWithFit } from "../model/fit_mates";
import { liveNumbers } from "../model/hints";
import { chooseCardMate, chosenCardMate } from "../model/view_state";
import type { Fit, Mate } from "../protocol/messages";
import { canSteer, store, studio, view } from "./app_state";
import { figures, number, t } from "./i18n";
import { holdingHand, setText, useLive } from "./live";
import { ToleranceZones } from "./tolerance_zones";

const kCommonFits = ["H7/g6", "H7/h6", "H7/k6", "H7/n6", "H7/p6", "H7/s6", "H8/f7", "H11/c11"];

const nameOf = (occurrence: number) => store.occurrences.value.get(occurrence)?.name ?? "";

/** "Shaft in Bushing". */
const mateText = (mate: Mate) => t("fit.of", { inner: nameOf(mate.b), outer: nameOf(mate.a) });

/** Which of the mates of these parts the card is about: the one that was chosen, for as long as it is there. */
function useCardMate(parts: readonly number[], mates: readonly Mate[]): Mate | null {
  const guiding = store.held.value.find((each) => parts.includes(each.occurrence))?.mate ?? null;
  const chosen = chosenCardMate(view, parts);
  const mate = mates.find((each) => mateKey(each) === chosen) ?? firstMate(mates, guiding);
  const key = mate === null ? null : mateKey(mate);
  useEffect(() => {
    if (key !== null && key !== chosen) {
      chooseCardMate(view, parts, key);
    }
  }, [key, chosen]);
  return mate;
}

function MateChoice({ parts, mates, mate }: { parts: readonly number[]; mates: readonly Mate[]; mate: Mate }) {
  if (mates.length === 1) {
    return <p data-testid="fit-mate">{mateText(mate)}</p>;
  }
  return (
    <select
      class="mate-choice"
      aria-label={t("fit.mate")}
      data-testid="fit-mate"
      value={mateKey(mate)}
      onChange={(event) => chooseCardMate(view, parts, event.currentTarget.value)}
    >
      {mates.map((each) => (
        <option key={mateKey(each)} value={mateKey(each)}>
          {mateText(each)}
          {each.fit === null ? "" : ` · ${each.fit.code}`}
        </option>
      ))}
    </select>
  );
}

/** Clearance is told as such, and as interference where both limits are below zero. A thread has no limits by ISO 286. */
function limits(fit: Fit): { label: string; text: string; actual: string; along: string } {
  const { clearance_min_um: min, clearance_max_um: max, clearance_actual_um: actual, clearance_along_um: along } = fit;
  const isTight = max !== null && max <= 0;
  const sign = isTight ? -1 : 1;
  const range = (ends: readonly number[], decimals: number) => {
    const [low, high] = ends.map((end) => sign * end).sort((a, b) => a - b);
    return `${number(low ?? 0, decimals)} … ${number(high ?? 0, decimals)} µm`;
  };
  return {
    label: t(isTight ? "fit.limitsInterference" : "fit.limits"),
    text: min === null || max === null ? "–" : range([min, max], 0),
    actual: actual === null ? "–" : `${number(sign * actual, 1)} µm`,
    along: along === null ? "–" : range(along, 1),
  };
}

function FitForces({ parts }: { parts: readonly number[] }) {
  const axialTrue = useRef<HTMLElement>(null);
  const axialFelt = useRef<HTMLElement>(null);
  const felt = useRef<HTMLElement>(null);
  const ratio = useRef<HTMLElement>(null);
  useLive((live) => {
    const held = store.held.peek().find((each) => parts.includes(each.occurrence));
    const hand = held === undefined ? null : holdingHand(live, held.occurrence);
    const newtons = (value: number | undefined) => (value === undefined ? "–" : `${value < 1e-3 ? 0 : figures(value)} N`);
    const values = hand === null ? null : liveNumbers(hand);
    setText(axialTrue.current, newtons(hand?.axial_true_n));
    setText(axialFelt.current, newtons(hand?.axial_felt_n));
    setText(felt.current, newtons(values?.feltN));
    const hasRatio = values !== null && values.trueN > 0.05;
    setText(ratio.current, hasRatio ? `${figures(values.feltN / values.trueN, 2)} ×` : "–");
  });
  return (
    <>
      <dt>{t("fit.axialTrue")}</dt>
      <dd ref={axialTrue} />
      <dt>{t("fit.axialFelt")}</dt>
      <dd ref={axialFelt} />
      <dt>{t("fit.felt")}</dt>
      <dd ref={felt} />
      <dt>{t("fit.scale")}</dt>
      <dd ref={ratio} />
    </>
  );
}

function FitChoice({ mate }: { mate: Mate }) {
  const wanted = useSignal(mate.fit?.code ?? "");
  const isSound = isFitCode(wanted.value);
  useEffect(() => void (wanted.value = mate.fit?.code ?? ""), [mate.fit?.code]);
  const apply = (event: Event) => {
    event.preventDefault();
    if (isSound) {
      void studio.command({ command: "assign_fit", mate: mate.id, fit: wanted.value.trim() });
    }
  };
  return (
    <form class="fit-choice" onSubmit={apply}>
      <input
        list="common-fits"
        value={wanted.value}
        aria-label={t("fit.choose")}
        aria-invalid={!isSound && wanted.value.trim() !== ""}
        title={t("fit.bad")}
        placeholder="H7/g6"
        data-testid="fit-input"
        onInput={(event) => (wanted.value = event.currentTarget.value)}
      />
      <datalist id="common-fits">
        {kCommonFits.map((code) => (
          <option key={code} value={code} />
        ))}
      </datalist>
      <button
        type="submit"
        class="small-button"
        data-testid="fit-apply"
        disabled={!isSound || wanted.value.trim() === mate.fit?.code}
      >
        {t("fit.apply")}
      </button>
    </form>
  );
}

/** @param parts  One part, or two that have a mate with each other. */
export function FitCard({ parts }: { parts: readonly number[] }) {
  const mates = matesWithFit(store.scene.value?.mates ?? [], parts);
  const mate = useCardMate(parts, mates);
  if (mate === null) {
    return null;
  }
  const { fit } = mate;
  const told = fit === null ? null : limits(fit);
  return (
    <section class="card-group" aria-labelledby="fit-title">
      <h2 id="fit-title">{t("fit.title")}</h2>
      <div class="card" data-testid="fit-card" data-mate={mate.id}>
        <MateChoice parts={parts} mates={mates} mate={mate} />
        <h3>
          {fit === null ? t("fit.none") : `${fit.code} · ${t(`fit.${fit.kind}`)}`}
          {fit?.is_proposed ? <span class="badge">{t("fit.proposed")}</span> : null}
        </h3>
        {fit === null ? null : (
          <p class="quiet" title={fit.reason}>
            {mate.kind === "prismatic"
              ? t("fit.width", { mm: number(fit.diameter_mm) })
              : `⌀ ${number(fit.diameter_mm)} mm`}
          </p>
        )}
        <dl class="facts">
          {told !== null ? <dt>{told.label}</dt> : null}
          {told !== null ? <dd>{told.text}</dd> : null}
          {told !== null ? <dt>{t("fit.actual", { seed: store.scene.value?.seed ?? "" })}</dt> : null}
          {told !== null ? <dd>{told.actual}</dd> : null}
          {told !== null ? <dt>{t("fit.along")}</dt> : null}
          {told !== null ? <dd>{told.along}</dd> : null}
          <FitForces parts={parts} />
        </dl>
        {fit === null ? null : <ToleranceZones fit={fit} isRound={mate.kind !== "prismatic"} />}
        {canSteer() && canHaveFit(mate) ? <FitChoice mate={mate} key={mateKey(mate)} /> : null}
      </div>
    </section>
  );
}
