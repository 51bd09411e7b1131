/** Curves of what a hand feels over time, with their values now or under the pointer. */

import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import type uPlot from "uplot";
import { readSeries, type TraceField } from "../model/trace";
import { liveTraces, studio, ui, view, viewport } from "./app_state";
import { figures, language, t } from "./i18n";
import { setText } from "./live";
import { followSize, makeTimePlot, type Curve, type PlotTime } from "./plot_canvas";
import { plotClock, plottedHand, shownSpan, traceOf } from "./time_source";

const kRedrawMs = 45;

export interface Quantity extends Curve {
  field: TraceField;
  /** From SI to what is plotted. */
  factor: number;
}

interface ChartProps {
  name: string;
  unit: string;
  curves: readonly Quantity[];
  ranges: Readonly<Record<string, number>>;
  title: ComponentChildren;
  tools?: ComponentChildren;
}

/** The newest of what the trace has, and of a recording what it had then. */
function readNow(curve: Quantity): number | null {
  const trace = traceOf(plottedHand());
  const clock = plotClock();
  const index = trace.indexAt(clock.nowS + 1e-9) - 1;
  return index < 0 ? null : curve.factor * trace.valueAt(index, curve.field);
}

function readCurves(curves: readonly Quantity[], time: PlotTime): number[][] {
  const fields = curves.map((curve) => curve.field);
  const series = readSeries(traceOf(plottedHand()), fields, time.fromS, time.toS);
  return [
    series.timesS.map((timeS) => timeS - time.originS),
    ...series.columns.map((column, k) => column.map((value) => value * (curves[k]?.factor ?? 1))),
  ];
}

/** Draws whenever there is something new to show. */
function startDrawing(plot: uPlot, time: PlotTime, curves: readonly Quantity[], onDrawn: (count: number) => void) {
  let last = 0;
  let drawn = "";
  return viewport.peek()?.onFrame((_, now) => {
    if (studio.liveFrames === null || now - last < kRedrawMs) {
      return;
    }
    last = now;
    liveTraces.follow(studio.liveFrames);
    const clock = plotClock();
    const span = shownSpan();
    const key = [plottedHand(), clock.isReplay, clock.nowS, span.fromS, span.toS].join("/");
    if (key === drawn) {
      return;
    }
    drawn = key;
    const isAlong = !clock.isReplay && ui.plotSpan.peek() === null;
    Object.assign(time, span, { originS: isAlong ? clock.nowS : 0 });
    const data = readCurves(curves, time);
    plot.setData(data as uPlot.AlignedData);
    onDrawn(data[0]?.length ?? 0);
  });
}

export function Chart({ name, unit, curves, ranges, title, tools }: ChartProps) {
  const host = useRef<HTMLDivElement>(null);
  const idle = useRef<HTMLParagraphElement>(null);
  const values = useRef<(HTMLElement | null)[]>([]);
  const port = viewport.value;
  // Canvases do not follow CSS: made anew when the theme or the language changes.
  const look = `${view.isDark.value}/${language.value}/${name}`;
  useEffect(() => {
    const element = host.current;
    if (element === null) {
      return;
    }
    let cursor: number | null = null;
    const tell = () =>
      curves.forEach((curve, k) => {
        const value = cursor === null ? readNow(curve) : (plot.data[k + 1]?.[cursor] ?? null);
        setText(values.current[k] ?? null, value === null ? "" : figures(value));
      });
    const time: PlotTime = { originS: 0, fromS: 0, toS: 1 };
    const plot = makeTimePlot(element, time, curves, ranges, (index) => {
      cursor = index;
      tell();
    });
    const stopSize = followSize(plot, element);
    const stopDrawing = startDrawing(plot, time, curves, (count) => {
      idle.current?.classList.toggle("is-shown", count === 0);
      tell();
    });
    return () => {
      stopDrawing?.();
      stopSize();
      plot.destroy();
    };
  }, [look, port]);
  return (
    <figure class="chart">
      <figcaption>
        {title}
        <span class="chart-unit">{unit}</span>
        {curves.map((curve, k) => (
          <span key={curve.label} class="chart-key" style={{ color: `var(${curve.color})` }}>
            {curve.label} <span class="chart-value" ref={(element) => void (values.current[k] = element)} />
          </span>
        ))}
        {tools}
      </figcaption>
      <div class="chart-canvas" ref={host} role="img" aria-label={`${name} ${unit}`} />
      <p class="chart-idle quiet is-shown" ref={idle}>
        {t("plot.idle")}
      </p>
    </figure>
  );
}
