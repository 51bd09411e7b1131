/** Force and depth over time, and beside them events, runs, rates and the comparison of recordings. */

import { kWindowsS } from "../model/plot_range";
import type { TraceField } from "../model/trace";
import { ui, type BottomTab } from "./app_state";
import { Chart, type Quantity } from "./chart";
import { EventList } from "./event_list";
import { savePlot } from "./exports";
import { number, t } from "./i18n";
import { Icon } from "./icons";
import { Lazy } from "./lazy";
import { Rates } from "./rates";
import { RunsTable } from "./run_card";
import { plotHands, plottedHand } from "./time_source";

const kColors = ["--s-red", "--s-orange", "--s-blue"] as const;

function vector(letter: string, fields: readonly [TraceField, TraceField, TraceField]): Quantity[] {
  return fields.map((field, k) => ({ field, factor: 1, label: `${letter}${"xyz"[k]}`, color: kColors[k]! }));
}

const kForce = vector("F", ["fx_n", "fy_n", "fz_n"]);
const kTorque = vector("T", ["tx_nm", "ty_nm", "tz_nm"]);
const kForceRanges = { n: 1 };
const kTorqueRanges = { nm: 0.05 };
const kDepthRanges = { mm: 5, deg: 2 };

function ForceOrTorque() {
  const isTorque = ui.showsTorque.value;
  return (
    <span class="chart-choice" role="group" aria-label={t("plot.switch")}>
      {([false, true] as const).map((each) => (
        <button
          key={String(each)}
          type="button"
          class="chart-title"
          aria-pressed={each === isTorque}
          data-testid={each ? "plot-torque" : "plot-force"}
          onClick={() => (ui.showsTorque.value = each)}
        >
          {t(each ? "plot.torque" : "plot.force")}
        </button>
      ))}
    </span>
  );
}

function windowName(seconds: number): string {
  return seconds < 60 ? t("plot.windowS", { n: seconds }) : t("plot.windowMin", { n: number(seconds / 60, 0) });
}

function PlotTools() {
  const isHeld = ui.plotSpan.value !== null;
  const hands = plotHands();
  return (
    <span class="plot-tools">
      {hands.length > 1 ? (
        <select
          aria-label={t("plot.hand")}
          data-testid="plot-hand"
          value={plottedHand()}
          onChange={(event) => (ui.plotHand.value = Number(event.currentTarget.value))}
        >
          {hands.map((hand) => (
            <option key={hand} value={hand}>
              {t("hands.name", { n: hand + 1 })}
            </option>
          ))}
        </select>
      ) : null}
      {isHeld ? (
        <button type="button" class="plot-button" data-testid="plot-unzoom" onClick={() => (ui.plotSpan.value = null)}>
          {t("plot.unzoom")}
        </button>
      ) : (
        <select
          aria-label={t("plot.window")}
          data-testid="plot-window"
          value={ui.plotSeconds.value}
          onChange={(event) => (ui.plotSeconds.value = Number(event.currentTarget.value))}
        >
          {kWindowsS.map((seconds) => (
            <option key={seconds} value={seconds}>
              {windowName(seconds)}
            </option>
          ))}
        </select>
      )}
      <button
        type="button"
        class="icon-button is-small"
        aria-label={t("action.plotCsv")}
        title={t("action.plotCsv")}
        data-testid="plot-csv"
        onClick={savePlot}
      >
        <Icon name="download" size={15} />
      </button>
    </span>
  );
}

function Charts() {
  const isTorque = ui.showsTorque.value;
  const depth: Quantity[] = [
    { field: "depth_m", factor: 1e3, label: t("plot.depth"), color: "--s-green", scale: "mm" },
    { field: "tilt_rad", factor: 180 / Math.PI, label: t("plot.tilt"), color: "--s-violet", scale: "deg" },
  ];
  return (
    <>
      <Chart
        key={isTorque ? "torque" : "force"}
        name={t(isTorque ? "plot.torque" : "plot.force")}
        unit={isTorque ? "N m" : "N"}
        curves={isTorque ? kTorque : kForce}
        ranges={isTorque ? kTorqueRanges : kForceRanges}
        title={<ForceOrTorque />}
      />
      <Chart
        name={`${t("plot.depth")} / ${t("plot.tilt")}`}
        unit="mm / °"
        curves={depth}
        ranges={kDepthRanges}
        title={
          <span class="chart-title">
            {t("plot.depth")} / {t("plot.tilt")}
          </span>
        }
        tools={<PlotTools />}
      />
    </>
  );
}

const kTabs: readonly BottomTab[] = ["events", "runs", "rates", "compare"];
/** These need the room of the charts. */
const isWide = (tab: BottomTab) => tab === "rates" || tab === "compare";

function TabContent({ tab }: { tab: BottomTab }) {
  switch (tab) {
    case "events":
      return <EventList />;
    case "runs":
      return <RunsTable />;
    case "rates":
      return <Rates />;
    case "compare":
      return <Lazy load={() => import("./compare")} />;
  }
}

export function Plots() {
  const tab = ui.bottomTab.value;
  const onKeyDown = (event: KeyboardEvent) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step !== 0) {
      const to = kTabs[(kTabs.indexOf(tab) + step + kTabs.length) % kTabs.length]!;
      ui.bottomTab.value = to;
      document.getElementById(`tab-${to}`)?.focus();
    }
  };
  return (
    <section class={`plots ${isWide(tab) ? "is-wide" : ""}`} aria-label={t("action.panelPlots")}>
      {isWide(tab) ? null : <Charts />}
      <div class="tabs-panel">
        <div class="tabs" role="tablist" aria-label={t("action.panelPlots")} onKeyDown={onKeyDown}>
          {kTabs.map((name) => (
            <button
              key={name}
              type="button"
              role="tab"
              id={`tab-${name}`}
              aria-selected={tab === name}
              aria-controls="tab-content"
              tabIndex={tab === name ? 0 : -1}
              data-testid={`tab-${name}`}
              onClick={() => (ui.bottomTab.value = name)}
            >
              {t(`tabs.${name}`)}
            </button>
          ))}
        </div>
        <div class="tab-content" id="tab-content" role="tabpanel" aria-labelledby={`tab-${tab}`} tabIndex={0}>
          <TabContent tab={tab} />
        </div>
      </div>
    </section>
  );
}
