/** Is the loop on time? Rates of the last second, and how long ticks took and how late they came. */

import { useRef } from "preact/hooks";
import { makeBars } from "../model/histogram";
import { store } from "./app_state";
import { number, t } from "./i18n";
import { ageText, setText, useLive } from "./live";

const kBarWidth = 10;
const kHeight = 60;

function microseconds(us: number): string {
  return us >= 1000 ? `${number(us / 1000)} ms` : `${number(us)} µs`;
}

function Histogram({ title, edgesUs, counts }: { title: string; edgesUs: readonly number[]; counts: readonly number[] }) {
  const bars = makeBars(edgesUs, counts);
  const nameOf = (k: number) => {
    const bar = bars[k]!;
    const range =
      bar.toUs === Infinity
        ? t("rates.above", { us: microseconds(bar.fromUs) })
        : t("rates.upTo", { us: microseconds(bar.toUs) });
    return `${range}: ${number(bar.count, 0)}`;
  };
  const filled = bars.flatMap((bar, k) => (bar.count > 0 ? [nameOf(k)] : []));
  const width = kBarWidth * bars.length;
  return (
    <figure class="histogram">
      <figcaption class="chart-title">{title}</figcaption>
      <svg
        viewBox={`0 0 ${width} ${kHeight}`}
        preserveAspectRatio="none"
        role="img"
        aria-label={`${title}: ${filled.join(", ")}`}
      >
        {bars.map((bar, k) => (
          <g key={k}>
            <title>{nameOf(k)}</title>
            <rect class="histogram-room" x={kBarWidth * k} y={0} width={kBarWidth} height={kHeight} />
            <rect
              class={`histogram-bar ${bar.fromUs >= 1000 ? "is-late" : ""}`}
              x={kBarWidth * k + 0.75}
              y={kHeight * (1 - bar.height)}
              width={kBarWidth - 1.5}
              height={kHeight * bar.height}
            />
          </g>
        ))}
      </svg>
      <p class="histogram-ends" aria-hidden="true">
        <span>0</span>
        <span>{microseconds(edgesUs[Math.floor(edgesUs.length / 2)] ?? 0)}</span>
        <span>{t("rates.above", { us: microseconds(edgesUs.at(-1) ?? 0) })}</span>
      </p>
    </figure>
  );
}

export function Rates() {
  const age = useRef<HTMLElement>(null);
  useLive((live) => setText(age.current, ageText(live)), 400);
  const status = store.status.value;
  if (status === null) {
    return <p class="quiet">{t("rates.none")}</p>;
  }
  const facts: [string, string][] = [
    [t("rates.tick"), `${number(status.tick_hz, 0)} Hz`],
    [t("rates.physics"), `${number(status.physics_hz, 0)} Hz`],
    [t("rates.late"), number(status.late_ticks, 0)],
    [t("rates.lostEvents"), number(status.lost_events, 0)],
    [t("rates.truncated"), number(status.truncated_ticks, 0)],
    [t("rates.crowded"), number(status.crowded_ticks, 0)],
    [t("rates.computeP99"), microseconds(status.compute_p99_us)],
    [t("rates.wakeUpP99"), microseconds(status.wake_up_p99_us)],
    [t("rates.scheduling"), status.scheduling],
  ];
  const { histograms } = status;
  return (
    <div class="rates" data-testid="rates">
      <dl class="facts">
        {facts.map(([name, value]) => [<dt key={name}>{name}</dt>, <dd key={`${name}=`}>{value}</dd>])}
        <dt>{t("rates.age")}</dt>
        <dd ref={age} />
      </dl>
      {histograms === undefined ? null : (
        <>
          <Histogram title={t("rates.compute")} edgesUs={histograms.edges_us} counts={histograms.compute} />
          <Histogram title={t("rates.wakeUp")} edgesUs={histograms.edges_us} counts={histograms.wake_up} />
        </>
      )}
    </div>
  );
}
