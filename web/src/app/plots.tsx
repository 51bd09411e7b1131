/** Force and depth over the last seconds, and beside them events and runs. */

import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { kWindowS, readWindow, type PlotWindow } from "../model/samples";
import { studio, ui, view, viewport } from "./app_state";
import { EventList } from "./event_list";
import { language, number, t } from "./i18n";
import { RunsTable } from "./run_card";

const kRedrawMs = 45;

interface Curve {
  label: string;
  /** Name of the CSS variable. */
  color: string;
  scale?: string;
}

function cssColor(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function axis(scale: string, isTime: boolean, side?: uPlot.Axis.Side): uPlot.Axis {
  const ink = cssColor("--ink-2");
  return {
    scale,
    stroke: ink,
    font: "11px Inter, system-ui, sans-serif",
    size: isTime ? 22 : 40,
    space: isTime ? 60 : 22,
    gap: 4,
    grid: { stroke: cssColor("--line"), width: 1, show: side !== 1 },
    ticks: { show: false },
    values: (_, all) => all.map((v) => (isTime ? `${number(v)}` : number(v))),
    ...(side === undefined ? {} : { side }),
  };
}

function makePlot(host: HTMLElement, curves: readonly Curve[], ranges: Record<string, number>): uPlot {
  const scales: uPlot.Scales = { x: { time: false, range: () => [-kWindowS, 0] } };
  for (const [name, least] of Object.entries(ranges)) {
    // Never so narrow that noise looks like a signal.
    scales[name] = { range: (_, low, high) => [Math.min(low ?? 0, name === "deg" ? 0 : -least / 4) * 1.05, Math.max(high ?? 0, least) * 1.05] };
  }
  const names = Object.keys(ranges);
  const options: uPlot.Options = {
    width: Math.max(50, host.clientWidth),
    height: Math.max(40, host.clientHeight),
    legend: { show: false },
    cursor: { drag: { x: false, y: false }, points: { show: false } },
    scales,
    axes: [axis("x", true), ...names.map((name, k) => axis(name, false, k === 1 ? 1 : undefined))],
    series: [
      {},
      ...curves.map((curve) => ({
        label: curve.label,
        stroke: cssColor(curve.color),
        scale: curve.scale ?? names[0] ?? "y",
        width: 1.5,
        points: { show: false },
      })),
    ],
  };
  return new uPlot(options, [[], ...curves.map(() => [])], host);
}

interface ChartProps {
  title: string;
  unit: string;
  curves: readonly Curve[];
  ranges: Record<string, number>;
  read: (window: PlotWindow) => number[][];
  onTitle?: () => void;
}

function Chart({ title, unit, curves, ranges, read, onTitle }: ChartProps) {
  const host = useRef<HTMLDivElement>(null);
  const idle = useRef<HTMLParagraphElement>(null);
  const port = viewport.value;
  // Canvases do not follow CSS: made anew when the theme or the language changes.
  const look = `${view.isDark.value}/${language.value}/${title}`;
  useEffect(() => {
    const element = host.current;
    if (element === null) {
      return;
    }
    const plot = makePlot(element, curves, ranges);
    const observer = new ResizeObserver(() => {
      plot.setSize({ width: Math.max(50, element.clientWidth), height: Math.max(40, element.clientHeight) });
    });
    observer.observe(element);
    let last = 0;
    let count = -1;
    const stop = port?.onFrame((_, now) => {
      const frames = studio.frames;
      if (frames === null || now - last < kRedrawMs || frames.sampleCount === count) {
        return;
      }
      last = now;
      count = frames.sampleCount;
      const samples = readWindow(frames, 0);
      idle.current?.classList.toggle("is-shown", samples.time.length === 0);
      plot.setData([samples.time, ...read(samples)] as uPlot.AlignedData);
    });
    return () => {
      stop?.();
      observer.disconnect();
      plot.destroy();
    };
  }, [look, port]);
  return (
    <figure class="chart">
      <figcaption>
        {onTitle === undefined ? (
          <span class="chart-title">{title}</span>
        ) : (
          <button type="button" class="chart-title" title={t("plot.switch")} onClick={onTitle}>
            {title}
          </button>
        )}
        <span class="chart-unit">{unit}</span>
        {curves.map((curve) => (
          <span key={curve.label} class="chart-key" style={{ color: `var(${curve.color})` }}>
            {curve.label}
          </span>
        ))}
      </figcaption>
      <div class="chart-canvas" ref={host} role="img" aria-label={`${title} ${unit}`} />
      <p class="chart-idle quiet is-shown" ref={idle}>
        {t("plot.idle")}
      </p>
    </figure>
  );
}

const kForce: Curve[] = [
  { label: "Fx", color: "--s-red" },
  { label: "Fy", color: "--s-orange" },
  { label: "Fz", color: "--s-blue" },
];
const kTorque: Curve[] = [
  { label: "Tx", color: "--s-red" },
  { label: "Ty", color: "--s-orange" },
  { label: "Tz", color: "--s-blue" },
];

export function Plots() {
  const tab = ui.bottomTab.value;
  const isTorque = ui.showsTorque.value;
  const flip = () => (ui.showsTorque.value = !isTorque);
  return (
    <section class="plots" aria-label={t("action.panelPlots")}>
      {isTorque ? (
        <Chart key="t" title={t("plot.torque")} unit="N m" curves={kTorque} ranges={{ nm: 0.05 }} read={(w) => w.torque} onTitle={flip} />
      ) : (
        <Chart key="f" title={t("plot.force")} unit="N" curves={kForce} ranges={{ n: 1 }} read={(w) => w.force} onTitle={flip} />
      )}
      <Chart
        title={`${t("plot.depth")} / ${t("plot.tilt")}`}
        unit="mm / °"
        curves={[
          { label: t("plot.depth"), color: "--s-green", scale: "mm" },
          { label: t("plot.tilt"), color: "--s-violet", scale: "deg" },
        ]}
        ranges={{ mm: 5, deg: 2 }}
        read={(w) => [w.depthMm, w.tiltDeg]}
      />
      <div class="tabs-panel">
        <div class="tabs" role="tablist">
          {(["events", "runs"] as const).map((name) => (
            <button
              key={name}
              type="button"
              role="tab"
              id={`tab-${name}`}
              aria-selected={tab === name}
              aria-controls="tab-content"
              data-testid={`tab-${name}`}
              onClick={() => (ui.bottomTab.value = name)}
            >
              {t(`tabs.${name}`)}
            </button>
          ))}
        </div>
        <div class="tab-content" id="tab-content" role="tabpanel" aria-labelledby={`tab-${tab}`} tabIndex={0}>
          {tab === "events" ? <EventList /> : <RunsTable />}
        </div>
      </div>
    </section>
  );
}
