/** Numbers as people type them: with a unit, or in the one that is usual there. */

const kLengths: Record<string, number> = {
  "µm": 1e-6,
  um: 1e-6,
  mm: 1e-3,
  cm: 1e-2,
  m: 1,
  in: 0.0254,
  inch: 0.0254,
  '"': 0.0254,
  ft: 0.3048,
  "'": 0.3048,
  thou: 2.54e-5,
  mil: 2.54e-5,
};
const kAngles: Record<string, number> = {
  "°": Math.PI / 180,
  deg: Math.PI / 180,
  rad: 1,
  mrad: 1e-3,
  turn: 2 * Math.PI,
};

export type QuantityKind = "length" | "angle";
const kUnits: Record<QuantityKind, Record<string, number>> = { length: kLengths, angle: kAngles };
const kUsual: Record<QuantityKind, string> = { length: "mm", angle: "°" };

/** In SI; null where it is no number, or of a unit that is not known.
 "38", "38 mm", "1.5 in", "1,5 cm", "1/4 in", "-2.5e-1 m". */
export function parseQuantity(text: string, kind: QuantityKind): number | null {
  const match = /^\s*([-+]?\d*[.,]?\d+(?:e[-+]?\d+)?|[-+]?\d+[.,])(?:\s*\/\s*(\d+))?\s*([^\d\s]*)\s*$/i.exec(text);
  if (match === null) {
    return null;
  }
  const [, digits = "", divisor, unit = ""] = match;
  const units = kUnits[kind];
  const name = unit === "" ? kUsual[kind] : unit.toLowerCase().replace("μ", "µ");
  const factor = Object.hasOwn(units, name) ? units[name]! : null;
  const value = Number(digits.replace(",", ".")) / (divisor === undefined ? 1 : Number(divisor));
  return factor === null || !Number.isFinite(value) ? null : value * factor;
}

/** Of a value in SI, in the usual unit. */
export function inUsualUnit(value: number, kind: QuantityKind): number {
  return value / kUnits[kind][kUsual[kind]]!;
}

export function usualUnit(kind: QuantityKind): string {
  return kUsual[kind];
}
