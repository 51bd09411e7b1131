/** A plot over time on a canvas: axes, marquee, cursor, and the line of the moment that is played. */

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { markedSpan } from "../model/plot_range";
import { studio, ui } from "./app_state";
import { duration, language, number } from "./i18n";
import { seek } from "./time_source";

export interface Curve {
  label: string;
  /** Name of the CSS variable. */
  color: string;
  scale?: string;
  dash?: number[];
}

/** Around the plot, as uPlot takes it: top, right, bottom, left [px]. */
export const kPadding: uPlot.Padding = [6, 8, 0, 0];
const kRight: uPlot.Axis.Side = 1;
/** A press that moves less than this is a click [px]. */
const kClickPx = 4;

export function cssColor(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export function makeAxis(scale: string, isBelow: boolean, side?: uPlot.Axis.Side): uPlot.Axis {
  return {
    scale,
    stroke: cssColor("--ink-2"),
    font: "11px Inter, system-ui, sans-serif",
    size: isBelow ? 22 : 40,
    space: isBelow ? 60 : 16,
    gap: 4,
    grid: { stroke: cssColor("--line"), width: 1, show: side !== kRight },
    ticks: { show: false },
    values: (_, all) => all.map((v) => number(v)),
    ...(side === undefined ? {} : { side }),
  };
}

export function sizeOf(host: HTMLElement): { width: number; height: number } {
  return { width: Math.max(50, host.clientWidth), height: Math.max(40, host.clientHeight) };
}

/** Follows the size of its host; returns what ends that. */
export function followSize(plot: uPlot, host: HTMLElement): () => void {
  const observer = new ResizeObserver(() => plot.setSize(sizeOf(host)));
  observer.observe(host);
  return () => observer.disconnect();
}

export function makeSeries(curve: Curve, scale: string): uPlot.Series {
  return {
    label: curve.label,
    stroke: cssColor(curve.color),
    scale: curve.scale ?? scale,
    width: 1.5,
    points: { show: false },
    ...(curve.dash === undefined ? {} : { dash: curve.dash }),
  };
}

/** Times of the axis: before now, of the recording, or of the day. */
function timeLabels(times: readonly number[], isHeld: boolean): string[] {
  if (studio.recordings.playback.peek() !== null) {
    return times.map((s) => (s < 60 ? number(s) : duration(s)));
  }
  if (!isHeld) {
    return times.map((s) => number(s));
  }
  const clock = new Intl.DateTimeFormat(language.value, { timeStyle: "medium", hourCycle: "h23" });
  return times.map((s) => clock.format(new Date(1e3 * s)));
}

/** A clock of its own, so that a window that goes along has the same marks all the time. */
export interface PlotTime {
  originS: number;
  fromS: number;
  toS: number;
}

/** @param time  What is shown; its owner changes it before each drawing.
 @param ranges  The scales, and the least that each of them shows.
 @param onCursor  Called with the index of the sample under the pointer, or null. */
export function makeTimePlot(
  host: HTMLElement,
  time: PlotTime,
  curves: readonly Curve[],
  ranges: Readonly<Record<string, number>>,
  onCursor: (index: number | null) => void,
): uPlot {
  const scales: uPlot.Scales = {
    x: { time: false, range: () => [time.fromS - time.originS, time.toS - time.originS] },
  };
  for (const [name, least] of Object.entries(ranges)) {
    // Never so narrow that noise looks like a signal.
    const lowest = name === "deg" ? 0 : -least / 4;
    scales[name] = { range: (_, low, high) => [1.05 * Math.min(low ?? 0, lowest), 1.05 * Math.max(high ?? 0, least)] };
  }
  const names = Object.keys(ranges);
  const below = makeAxis("x", true);
  below.values = (_, all) => timeLabels(all, ui.plotSpan.peek() !== null);
  const plot = new uPlot(
    {
      ...sizeOf(host),
      padding: kPadding,
      legend: { show: false },
      cursor: { drag: { x: true, y: false, setScale: false }, points: { show: false }, y: false, sync: { key: "time" } },
      scales,
      axes: [below, ...names.map((name, k) => makeAxis(name, false, k === 1 ? 1 : undefined))],
      series: [{}, ...curves.map((curve) => makeSeries(curve, names[0] ?? "y"))],
      hooks: {
        draw: [(self) => drawPlayhead(self, time)],
        setCursor: [(self) => onCursor((self.cursor.left ?? -1) < 0 ? null : (self.cursor.idx ?? null))],
        setSelect: [(self) => takeMarked(self, time)],
      },
    },
    [[], ...curves.map(() => [])],
    host,
  );
  listen(plot, time);
  return plot;
}

function takeMarked(plot: uPlot, time: PlotTime): void {
  const { left, width } = plot.select;
  if (width < kClickPx) {
    return;
  }
  const at = (px: number) => plot.posToVal(px, "x") + time.originS;
  ui.plotSpan.value = markedSpan(at(left), at(left + width)) ?? ui.plotSpan.peek();
  plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
}

function listen(plot: uPlot, time: PlotTime): void {
  let pressedAt = 0;
  plot.over.addEventListener("pointerdown", (event) => (pressedAt = event.clientX));
  plot.over.addEventListener("click", (event) => {
    const isClick = Math.abs(event.clientX - pressedAt) < kClickPx;
    if (isClick && studio.recordings.playback.peek() !== null) {
      seek(plot.posToVal(event.offsetX, "x") + time.originS);
    }
  });
  plot.over.addEventListener("dblclick", () => (ui.plotSpan.value = null));
}

function drawPlayhead(plot: uPlot, time: PlotTime): void {
  const playback = studio.recordings.playback.peek();
  const timeS = playback?.timeS ?? -Infinity;
  if (timeS < time.fromS || timeS > time.toS) {
    return;
  }
  const { ctx, bbox } = plot;
  const x = Math.round(plot.valToPos(timeS - time.originS, "x", true));
  ctx.save();
  ctx.strokeStyle = cssColor("--accent");
  ctx.lineWidth = 2 * devicePixelRatio;
  ctx.beginPath();
  ctx.moveTo(x, bbox.top);
  ctx.lineTo(x, bbox.top + bbox.height);
  ctx.stroke();
  ctx.restore();
}
