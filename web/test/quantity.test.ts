import { describe, expect, it } from "vitest";
import { inUsualUnit, parseQuantity } from "../src/model/quantity";

describe("a length", () => {
  it("is read with its unit, or in millimetres", () => {
    const lengths: [string, number][] = [
      ["38 mm", 0.038],
      ["38", 0.038],
      ["1.5 in", 0.0381],
      ["1,5 cm", 0.015],
      ['1/4"', 0.00635],
      ["-12.5 µm", -12.5e-6],
      [".5m", 0.5],
      ["2e-1 m", 0.2],
      ["3 thou", 7.62e-5],
    ];
    for (const [text, metres] of lengths) {
      expect(parseQuantity(text, "length"), text).toBeCloseTo(metres, 12);
    }
  });

  it("is refused where it is none", () => {
    for (const text of ["", "mm", "1 2", "1.2.3", "5 kg", "5 deg", "1/0 in", "constructor", "3 toString"]) {
      expect(parseQuantity(text, "length"), text).toBeNull();
    }
  });
});

describe("an angle", () => {
  it("is read with its unit, or in degrees", () => {
    expect(parseQuantity("90", "angle")).toBeCloseTo(Math.PI / 2);
    expect(parseQuantity("0.5 rad", "angle")).toBe(0.5);
    expect(parseQuantity("1/8 turn", "angle")).toBeCloseTo(Math.PI / 4);
    expect(parseQuantity("3 mm", "angle")).toBeNull();
  });

  it("comes back as it was typed", () => {
    expect(inUsualUnit(parseQuantity("12.5 deg", "angle")!, "angle")).toBeCloseTo(12.5, 12);
    expect(inUsualUnit(parseQuantity("1 in", "length")!, "length")).toBeCloseTo(25.4, 12);
  });
});
