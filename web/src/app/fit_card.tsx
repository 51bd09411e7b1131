/** The fit of the part that is inspected: limits, the size that was drawn, and its forces. */

import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { liveNumbers } from "../model/hints";
import type { Fit, Mate, Occurrence } from "../protocol/messages";
import { canSteer, store, studio } from "./app_state";
import { figures, number, t } from "./i18n";
import { holdingHand, setText, useLive } from "./live";

const kCommonFits = ["H7/g6", "H7/h6", "H7/k6", "H7/n6", "H7/p6", "H7/s6", "H8/f7", "H11/c11"];

/** The mate that holds now; else the tightest one that the part has. */
function chooseMate(part: Occurrence): Mate | null {
  const mates = (store.scene.value?.mates ?? []).filter((m) => m.a === part.id || m.b === part.id);
  const active = store.heldBy.value.get(part.id)?.mate;
  const axes = mates.filter((m) => m.kind === "axis_hole");
  const tightness = (m: Mate) => m.fit?.clearance_actual_um ?? Infinity;
  return (
    mates.find((m) => m.id === active && m.fit !== null) ??
    axes.filter((m) => m.fit !== null).sort((a, b) => tightness(a) - tightness(b))[0] ??
    axes[0] ??
    null
  );
}

/** Clearance is told as such, and as interference where both limits are below zero. */
function limits(fit: Fit): { label: string; text: string; actual: string } {
  const isTight = fit.clearance_max_um <= 0;
  const sign = isTight ? -1 : 1;
  const [low, high] = [sign * fit.clearance_min_um, sign * fit.clearance_max_um].sort((a, b) => a - b);
  return {
    label: t(isTight ? "fit.limitsInterference" : "fit.limits"),
    text: `${number(low ?? 0, 0)} … ${number(high ?? 0, 0)} µm`,
    actual: `${number(sign * fit.clearance_actual_um, 1)} µm`,
  };
}

function FitForces({ part }: { part: number }) {
  const axialTrue = useRef<HTMLElement>(null);
  const axialFelt = useRef<HTMLElement>(null);
  const felt = useRef<HTMLElement>(null);
  const ratio = useRef<HTMLElement>(null);
  useLive((live) => {
    const hand = holdingHand(live, part);
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
  const isSound = /^[A-Za-z]{1,2}\d{1,2}\/[A-Za-z]{1,2}\d{1,2}$/.test(wanted.value.trim());
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

export function FitCard({ part }: { part: Occurrence }) {
  const mate = chooseMate(part);
  if (mate === null) {
    return null;
  }
  const { fit } = mate;
  const other = store.occurrences.value.get(mate.a === part.id ? mate.b : mate.a);
  const told = fit === null ? null : limits(fit);
  return (
    <section class="card-group" aria-labelledby="fit-title">
      <h2 id="fit-title">{t("fit.title")}</h2>
      <div class="card">
        <h3>
          {fit === null ? t("fit.none") : `${fit.code} · ${t(`fit.${fit.kind}`)}`}
          {fit?.is_proposed ? <span class="badge">{t("fit.proposed")}</span> : null}
        </h3>
        <p class="quiet" title={fit?.reason}>
          {fit !== null ? `⌀ ${number(fit.diameter_mm)} mm · ` : ""}
          {t("fit.with", { name: other?.name ?? "" })}
        </p>
        <dl class="facts">
          {told !== null ? <dt>{told.label}</dt> : null}
          {told !== null ? <dd>{told.text}</dd> : null}
          {told !== null ? <dt>{t("fit.actual", { seed: store.scene.value?.seed ?? "" })}</dt> : null}
          {told !== null ? <dd>{told.actual}</dd> : null}
          <FitForces part={part.id} />
        </dl>
        {canSteer() && mate.kind === "axis_hole" ? <FitChoice mate={mate} key={mate.id} /> : null}
      </div>
    </section>
  );
}
