/** What floats over the view: section, explode, measuring, a new mate, the legend. */

import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { isFitCode } from "../model/fit_mates";
import { clearPicks } from "../model/view_state";
import type { FaceOf } from "../protocol/messages";
import { canSteer, store, studio, view, viewport } from "./app_state";
import { number, t } from "./i18n";
import { GroupLabels } from "./group_labels";
import { Icon } from "./icons";
import { useLive } from "./live";
import { QuantityEntry } from "./quantity_entry";
import { ApartPanel } from "./apart_panel";
import { PathPanel } from "./path_panel";
import { PeopleMarks } from "./people_marks";
import { FinishCard } from "./summary_card";
import { WorkshopPanel } from "./workshop_panel";

function SectionPanel() {
  const section = view.section.value;
  if (section === null) {
    return null;
  }
  const set = (change: Partial<typeof section>) => (view.section.value = { ...section, ...change });
  return (
    <div class="float-panel" role="group" aria-label={t("action.section")} data-testid="section-panel">
      <Icon name="section" />
      <div class="segments" role="radiogroup" aria-label={t("section.axis")}>
        {(["X", "Y", "Z"] as const).map((name, k) => (
          <button
            key={name}
            type="button"
            role="radio"
            aria-checked={section.axis === k}
            onClick={() => set({ axis: k as 0 | 1 | 2 })}
          >
            {name}
          </button>
        ))}
      </div>
      <input
        type="range"
        min={-1}
        max={1}
        step={0.005}
        value={section.offset}
        aria-label={t("section.offset")}
        data-testid="section-offset"
        onInput={(event) => set({ offset: Number(event.currentTarget.value) })}
      />
      <QuantityEntry
        kind="length"
        label={t("section.offset")}
        value={section.offset * (store.scene.value?.radius_m ?? 0)}
        digits={1}
        testId="section-mm"
        onChange={(metres) => set({ offset: Math.min(1, Math.max(-1, metres / (store.scene.value?.radius_m ?? 1))) })}
      />
      <button type="button" class="icon-button" aria-label={t("section.flip")} title={t("section.flip")} onClick={() => set({ isFlipped: !section.isFlipped })}>
        <Icon name="flip" />
      </button>
      <button type="button" class="icon-button" aria-label={t("dialog.close")} onClick={() => (view.section.value = null)}>
        <Icon name="close" />
      </button>
    </div>
  );
}

function ExplodePanel() {
  const amount = view.explode.value;
  if (amount === 0) {
    return null;
  }
  return (
    <div class="float-panel" role="group" aria-label={t("action.explode")} data-testid="explode-panel">
      <Icon name="explode" />
      <input
        type="range"
        min={0.01}
        max={1}
        step={0.01}
        value={amount}
        aria-label={t("explode.amount")}
        data-testid="explode-amount"
        onInput={(event) => (view.explode.value = Number(event.currentTarget.value))}
      />
      <button type="button" class="icon-button" aria-label={t("dialog.close")} onClick={() => (view.explode.value = 0)}>
        <Icon name="close" />
      </button>
    </div>
  );
}

function nameOf(face: FaceOf | undefined): string {
  return face === undefined ? "–" : `${store.occurrences.value.get(face.occurrence)?.name ?? ""} · ${face.face}`;
}

function MeasurePanel() {
  const m = view.measurement.value;
  const count = view.picked.value.length;
  const rows: [string, number | null | undefined, string, number][] = [
    [t("measure.distance"), m?.distance_mm, "mm", 3],
    [t("measure.angle"), m?.angle_deg, "°", 2],
    [t("measure.radius"), m?.radius_mm, "mm", 3],
    [t("measure.area"), m?.area_mm2, "mm²", 1],
  ];
  return (
    <div class="float-card" data-testid="measure-panel">
      <h2>{t("measure.title")}</h2>
      {count < 2 ? <p class="quiet">{t(count === 0 ? "measure.pick" : "measure.pickSecond")}</p> : null}
      {m !== null ? (
        <dl class="facts" data-testid="measurement">
          {rows
            .filter(([, value]) => value !== null && value !== undefined)
            .map(([name, value, unit, digits]) => [
              <dt key={name}>{name}</dt>,
              <dd key={`${name}=`}>
                {number(value ?? 0, digits)} {unit}
              </dd>,
            ])}
        </dl>
      ) : null}
      {m !== null && rows.every(([, value]) => typeof value !== "number") ? <p>{m.text}</p> : null}
    </div>
  );
}

function MatePanel() {
  const fit = useSignal("");
  const [a, b] = view.picked.value;
  const wanted = fit.value.trim();
  const isSound = wanted === "" || isFitCode(wanted);
  const create = async (event: Event) => {
    event.preventDefault();
    if (a === undefined || b === undefined || !isSound) {
      return;
    }
    const answer = await studio.command({ command: "add_mate", a, b, ...(wanted === "" ? {} : { fit: wanted }) });
    if (answer !== null) {
      clearPicks(view);
      view.tool.value = "hand";
    }
  };
  return (
    <form class="float-card" onSubmit={(event) => void create(event)} data-testid="mate-panel">
      <h2>{t("mate.title")}</h2>
      <p class="quiet">{a === undefined ? t("mate.pick") : b === undefined ? t("mate.pickSecond") : ""}</p>
      <ol class="picked">
        <li>{nameOf(a)}</li>
        <li>{nameOf(b)}</li>
      </ol>
      <label>
        {t("mate.fit")}
        <input
          value={fit.value}
          placeholder="H7/g6"
          title={t("fit.bad")}
          aria-invalid={!isSound}
          data-testid="mate-fit"
          onInput={(event) => (fit.value = event.currentTarget.value)}
        />
      </label>
      <p class="card-buttons">
        <button type="button" class="small-button" onClick={() => clearPicks(view)}>
          {t("mate.again")}
        </button>
        <button type="submit" class="small-button is-main" disabled={b === undefined || !isSound || !canSteer()} data-testid="mate-create">
          {t("mate.create")}
        </button>
      </p>
    </form>
  );
}

/** The text of a measurement, where it was measured. */
function MeasureLabel() {
  const label = useRef<HTMLDivElement>(null);
  const m = view.measurement.value;
  useLive(() => {
    const anchor = viewport.value?.product.marks.anchor;
    const element = label.current;
    if (!element || !anchor || !viewport.value) {
      return;
    }
    const at = viewport.value.project([anchor.x, anchor.y, anchor.z]);
    element.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
    element.hidden = at.isBehind;
  }, 0);
  const main = m?.distance_mm ?? m?.radius_mm ?? null;
  if (m === null || main === null) {
    return null;
  }
  return (
    <div class="measure-label" ref={label}>
      {m.distance_mm === null || m.distance_mm === undefined ? "R " : ""}
      {number(main, 3)} mm
    </div>
  );
}

function Legend() {
  const bar = useRef<HTMLElement>(null);
  const text = useRef<HTMLElement>(null);
  const isShown = view.showsForces.value && store.held.value.length > 0;
  useLive(() => {
    const port = viewport.value;
    const id = store.held.value[0]?.occurrence;
    const at = id === undefined ? null : port?.product.poseOf(id);
    if (!port || !at || bar.current === null || text.current === null) {
      return;
    }
    const px = port.product.arrowScale.now.perN / Math.max(1e-9, port.eye.metresPerPixel(at.p));
    const unit = [0.5, 1, 2, 5, 10, 20, 50, 100].find((n) => n * px >= 36) ?? 100;
    bar.current.style.width = `${Math.min(120, unit * px)}px`;
    text.current.textContent = `${number(unit)} N`;
  }, 200);
  if (!isShown) {
    return null;
  }
  return (
    <div class="legend" role="group" aria-label={t("legend.title")} data-testid="legend">
      <span class="legend-scale">
        <i ref={bar} class="legend-bar" />
        <span ref={text} class="figures" />
      </span>
      <span class="legend-key is-force">{t("legend.force")}</span>
      <span class="legend-key is-torque">{t("legend.torque")}</span>
      <span class="legend-key is-contact">{t("legend.contact")}</span>
      <span class="legend-key is-goal">{t("legend.goal")}</span>
      <button
        type="button"
        class="icon-button is-small"
        aria-pressed={view.locksForceScale.value}
        aria-label={t("action.forceScale")}
        title={t("action.forceScale")}
        onClick={() => (view.locksForceScale.value = !view.locksForceScale.value)}
      >
        <Icon name="lock" size={14} />
      </button>
    </div>
  );
}

/** Above the picture, below what must not be missed. */
export function FloatRow() {
  return store.scene.value === null ? null : (
    <div class="float-row">
      <SectionPanel />
      <ExplodePanel />
      <ApartPanel />
      <WorkshopPanel />
    </div>
  );
}

export function ViewPanels() {
  if (store.scene.value === null) {
    return null;
  }
  const tool = view.tool.value;
  return (
    <>
      {tool === "measure" ? <MeasurePanel /> : null}
      {tool === "mate" ? <MatePanel /> : null}
      {tool !== "mate" && tool !== "measure" ? <PathPanel /> : null}
      <MeasureLabel />
      <GroupLabels />
      <PeopleMarks />
      <Legend />
      <FinishCard />
    </>
  );
}
