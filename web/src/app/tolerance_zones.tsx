/** The picture of ISO 286-1: where the sizes of hole and shaft may lie beside the nominal size. */

import type { Fit } from "../protocol/messages";
import { number, t } from "./i18n";

const kWidth = 216;
const kHeight = 96;
const kMargin = 14; // for the figures above and below the zones
const kZone = { width: 52, hole: 42, shaft: 118 }; // where they stand

/** @param isRound  Of a slot the width counts, not a diameter. */
export function ToleranceZones({ fit, isRound }: { fit: Fit; isRound: boolean }) {
  const { hole_um: hole, shaft_um: shaft } = fit;
  if (hole === null || shaft === null) {
    return null;
  }
  const [low, high] = [Math.min(0, ...hole, ...shaft), Math.max(0, ...hole, ...shaft)];
  const scale = (kHeight - 2 * kMargin) / Math.max(1e-9, high - low);
  const y = (deviation: number) => kMargin + scale * (high - deviation);
  const signed = (deviation: number) => `${deviation > 0 ? "+" : ""}${number(deviation, 0)}`;
  const zone = (name: "hole" | "shaft", [lower, upper]: readonly number[]) => (
    <g class={`zone is-${name}`}>
      <rect x={kZone[name]} y={y(upper!)} width={kZone.width} height={Math.max(1, scale * (upper! - lower!))} />
      <text x={kZone[name] + kZone.width / 2} y={y(upper!) - 3}>{signed(upper!)}</text>
      <text x={kZone[name] + kZone.width / 2} y={y(lower!) + 10}>{signed(lower!)}</text>
    </g>
  );
  const told = t("zones.told", {
    hole: `${signed(hole[0])} … ${signed(hole[1])}`,
    shaft: `${signed(shaft[0])} … ${signed(shaft[1])}`,
  });
  return (
    <svg class="zones" viewBox={`0 0 ${kWidth} ${kHeight}`} role="img" aria-label={told} data-testid="zones">
      <line x1={kMargin} x2={kWidth - kMargin} y1={y(0)} y2={y(0)} />
      <text class="nominal" x={kWidth - kMargin} y={y(0) - 3}>
        {isRound ? "⌀ " : ""}
        {number(fit.diameter_mm)}
      </text>
      {zone("hole", hole)}
      {zone("shaft", shaft)}
      <text class="unit" x={kMargin} y={kMargin - 3}>µm</text>
    </svg>
  );
}
