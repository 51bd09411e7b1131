/** Curves of several recordings over one another: told apart by colour and by dashes. */

import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import type { Curve as Points } from "../model/compare";
import { language, t } from "./i18n";
import { view } from "./app_state";
import { followSize, kPadding, makeAxis, makeSeries, sizeOf } from "./plot_canvas";

/** Blue, orange, green and violet differ for colour-blind eyes too; the dashes tell all of them apart. */
export const kStyles: readonly { color: string; dash: number[] }[] = [
  { color: "--s-blue", dash: [] },
  { color: "--s-orange", dash: [8, 4] },
  { color: "--s-green", dash: [2, 3] },
  { color: "--s-violet", dash: [10, 3, 2, 3] },
  { color: "--s-red", dash: [5, 2] },
  { color: "--ink", dash: [1, 4] },
];

/** A piece of the line that curves of a style are drawn with. */
export function Dash({ style }: { style: number }) {
  const { color, dash } = kStyles[style]!;
  return (
    <svg class="dash" width={26} height={10} aria-hidden="true" style={{ color: `var(${color})` }}>
      <line x1={1} y1={5} x2={25} y2={5} stroke-dasharray={dash.join(" ")} />
    </svg>
  );
}

export interface NamedCurve {
  name: string;
  /** Which of the styles. */
  style: number;
  points: Points;
}

interface CompareChartProps {
  title: string;
  unitX: string;
  unitY: string;
  curves: readonly NamedCurve[];
}

function makePlot(host: HTMLElement, curves: readonly NamedCurve[]): uPlot {
  const tables = curves.map(({ points }) => [points.x, points.y] as uPlot.AlignedData);
  return new uPlot(
    {
      ...sizeOf(host),
      padding: kPadding,
      legend: { show: false },
      cursor: { drag: { x: true, y: false }, points: { show: false }, y: false },
      scales: { x: { time: false }, y: { range: (_, low, high) => [Math.min(0, low ?? 0), 1.05 * Math.max(0.1, high ?? 0)] } },
      axes: [makeAxis("x", true), makeAxis("y", false)],
      series: [
        {},
        ...curves.map(({ name, style }) => ({
          ...makeSeries({ label: name, ...kStyles[style]! }, "y"),
          // Each has its own times: between them there is nothing of the others.
          spanGaps: true,
        })),
      ],
    },
    tables.length === 0 ? [[]] : uPlot.join(tables),
    host,
  );
}

export function CompareChart({ title, unitX, unitY, curves }: CompareChartProps) {
  const host = useRef<HTMLDivElement>(null);
  const isDark = view.isDark.value;
  const words = language.value;
  useEffect(() => {
    const element = host.current!;
    const plot = makePlot(element, curves);
    const stopSize = followSize(plot, element);
    return () => {
      stopSize();
      plot.destroy();
    };
  }, [curves, isDark, words]);
  return (
    <figure class="chart">
      <figcaption>
        <span class="chart-title">{title}</span>
        <span class="chart-unit">{t("compare.over", { y: unitY, x: unitX })}</span>
      </figcaption>
      <div class="chart-canvas" ref={host} role="img" aria-label={`${title}: ${curves.map((c) => c.name).join(", ")}`} />
    </figure>
  );
}
