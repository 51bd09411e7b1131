/** A study, as whoever runs it sees it: who, what now, what there was, and how to stop it. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { liveNumbers } from "../../model/hints";
import type { ExperimenterState } from "../../protocol/messages";
import { store, studio } from "../app_state";
import { figures, number, t, tn } from "../i18n";
import { Icon } from "../icons";
import { holdingHand, setText, useLive } from "../live";
import { AbortDialog } from "./abort_dialog";
import { clock } from "./clock";
import { Notes } from "./notes";
import { Answers, TrialTable } from "./trial_table";
import "./experimenter.css";

const kTimeMs = 200;

const isOver = (state: ExperimenterState) => state.phase === "done" || state.phase === "declined";

function CopyLink({ link }: { link: string | null | undefined }) {
  if (!link) {
    return <p class="quiet">{t("desk.noLink")}</p>;
  }
  const whole = new URL(link, location.href).href;
  const copy = () =>
    void navigator.clipboard.writeText(whole).then(
      () => studio.notify(t("desk.copied")),
      () => studio.notify(t("desk.copyFailed"), true),
    );
  return (
    <p class="desk-link">
      <input readOnly value={whole} aria-label={t("desk.link")} data-testid="participant-link" onFocus={(event) => event.currentTarget.select()} />
      <button type="button" class="small-button" data-testid="copy-link" onClick={copy}>
        {t("desk.copy")}
      </button>
    </p>
  );
}

function Head({ state }: { state: ExperimenterState }) {
  const isThere = store.clients.value.some((client) => client.role === "participant");
  return (
    <header class="desk-head">
      <h2 class="desk-title">{state.title}</h2>
      <p class="desk-who">
        <strong data-testid="desk-participant">{state.participant}</strong>
        <span class={`desk-phase is-${state.phase}`} data-testid="desk-phase" data-phase={state.phase}>
          {t(`desk.phase.${state.phase}`)}
        </span>
        <span class={`badge ${isThere ? "is-done" : "is-next"}`} data-testid="desk-presence">
          {t(isThere ? "desk.present" : "desk.absent")}
        </span>
      </p>
      {isThere ? null : <CopyLink link={state.link} />}
      {state.is_resumed || state.interruptions > 0 ? (
        <p class="quiet">
          {state.is_resumed ? `${t("desk.resumed")} ` : ""}
          {state.interruptions > 0 ? tn("desk.interruptions", state.interruptions) : ""}
        </p>
      ) : null}
    </header>
  );
}

/** Time, force and depth, past the components. */
function Live({ state }: { state: ExperimenterState }) {
  const time = useRef<HTMLElement>(null);
  const felt = useRef<HTMLElement>(null);
  const real = useRef<HTMLElement>(null);
  const depth = useRef<HTMLElement>(null);
  useLive((live) => {
    const hand = holdingHand(live);
    const values = hand === null ? null : liveNumbers(hand);
    setText(felt.current, values === null ? "–" : `${figures(values.feltN)} N`);
    setText(real.current, values === null ? "–" : `${figures(values.trueN)} N`);
    setText(depth.current, values === null || values.depthGoalMm === 0 ? "–" : `${number(values.depthMm, 1)} / ${number(values.depthGoalMm, 0)} mm`);
  });
  useEffect(() => {
    const show = () => {
      const elapsed = studio.study.elapsedS();
      const limit = state.limit_s === null ? "" : ` / ${clock(state.limit_s)}`;
      setText(time.current, elapsed === null ? "–" : `${clock(elapsed)}${limit}`);
    };
    show();
    const timer = setInterval(show, kTimeMs);
    return () => clearInterval(timer);
  }, [state.limit_s]);
  return (
    <dl class="desk-live figures">
      <div>
        <dt>{t("study.time")}</dt>
        <dd ref={time} data-testid="desk-time" />
      </div>
      <div>
        <dt>{t("inspect.state")}</dt>
        <dd data-testid="desk-hold">{t(`state.${state.hold ?? "empty"}`)}</dd>
      </div>
      <div>
        <dt>{t("desk.felt")}</dt>
        <dd ref={felt} />
      </div>
      <div>
        <dt>{t("desk.true")}</dt>
        <dd ref={real} />
      </div>
      <div>
        <dt>{t("plot.depth")}</dt>
        <dd ref={depth} />
      </div>
    </dl>
  );
}

function Now({ state }: { state: ExperimenterState }) {
  const rows: [string, string | null][] = [
    [t("desk.condition"), state.condition === null ? null : [state.condition, state.condition_name].filter(Boolean).join(" · ")],
    [t("fit.title"), state.fit],
    [t("desk.repetition"), state.repetition === null ? null : number(state.repetition, 0)],
    [t("desk.block"), state.block === null ? null : state.is_identification ? `${state.block} (${t("desk.blind")})` : state.block],
    [t("desk.next"), state.next === null ? null : `${state.next.condition}, ${t("desk.repetition")} ${state.next.repetition}`],
  ];
  return (
    <section class="desk-card" aria-labelledby="desk-now">
      <h3 id="desk-now" data-testid="desk-now">
        {state.trial === null || state.trials === null ? t("desk.now") : t("study.progress", { n: state.trial, of: state.trials })}
      </h3>
      {state.instruction ? <p class="desk-instruction">{state.instruction}</p> : null}
      <dl class="facts">
        {rows
          .filter(([, value]) => value !== null)
          .map(([name, value]) => [<dt key={name}>{name}</dt>, <dd key={`${name}=`}>{value}</dd>])}
      </dl>
      <Live state={state} />
    </section>
  );
}

/** What comes next, and the way out. */
function Controls({ state }: { state: ExperimenterState }) {
  const isAborting = useSignal(false);
  const { study } = studio;
  const isOpening = state.phase === "waiting" && !state.is_open;
  const isOff = isOpening || study.isBusy.value || store.link.value !== "open" || store.role.value !== "operator";
  const main = {
    waiting: { id: "desk-begin", label: t(state.is_resumed ? "desk.goOn" : "desk.begin"), run: () => study.begin() },
    training: state.is_running
      ? { id: "desk-end-training", label: t("desk.endTraining"), run: () => study.next() }
      : { id: "desk-ready", label: t("study.trainingBegin"), run: () => study.ready() },
    ready: { id: "desk-ready", label: t("desk.startTrial"), run: () => study.ready() },
    running: { id: "desk-not-done", label: t("desk.notDone"), run: () => study.next() },
    paused: { id: "desk-resume", label: t("desk.resume"), run: () => study.resume() },
    consent: null,
    question: null,
    declined: null,
    done: null,
  }[state.phase];
  const mayAbort = !isOver(state) && state.phase !== "paused" && state.phase !== "waiting";
  return (
    <div class="desk-controls">
      {state.phase === "paused" && state.reason !== null ? (
        <p class="desk-reason" data-testid="desk-reason">
          {t("desk.pausedFor", { reason: state.reason })}
        </p>
      ) : null}
      {isOpening ? <p class="quiet">{t("desk.opening")}</p> : null}
      {main === null && !isOver(state) ? <p class="quiet">{t("desk.participantsTurn")}</p> : null}
      {isOver(state) ? <p>{t(state.phase === "done" ? "desk.isDone" : "desk.isDeclined", { folder: state.folder })}</p> : null}
      <p class="desk-buttons">
        {main === null ? null : (
          <button
            type="button"
            class={`small-button desk-button ${state.phase === "running" ? "" : "is-main"}`}
            data-testid={main.id}
            disabled={isOff}
            onClick={() => void main.run()}
          >
            {main.label}
          </button>
        )}
        {mayAbort ? (
          <button type="button" class="small-button desk-button is-abort" data-testid="desk-abort" disabled={isOff} onClick={() => (isAborting.value = true)}>
            <Icon name="stop" size={16} /> {t("desk.abort")}
          </button>
        ) : null}
      </p>
      {isAborting.value ? <AbortDialog onClose={() => (isAborting.value = false)} /> : null}
    </div>
  );
}

export default function Experimenter() {
  const state = studio.study.experimenter.value;
  if (state === null) {
    return null;
  }
  return (
    <aside class="desk" aria-label={t("desk.title")} data-testid="desk">
      <Head state={state} />
      <Controls state={state} />
      {isOver(state) ? null : <Now state={state} />}
      <Notes state={state} />
      <TrialTable state={state} />
      <Answers state={state} />
      <p class="desk-files quiet">
        {t("desk.files", { folder: state.folder, protocol: state.protocol, digest: state.digest.slice(0, 12) })}
      </p>
    </aside>
  );
}
