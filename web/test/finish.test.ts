import { describe, expect, it } from "vitest";
import { encodeFinish, finishOf, kPlainFinish } from "../src/model/finish";

describe("the finish of a material", () => {
  it("is that of a metal for names and designations in English and German", () => {
    const names = [
      "Steel C45", "Steel 8.8", "Spring steel", "Steel 16MnCr5", "1.4301", "Edelstahl", "Aluminium EN AW-6082", "AlMgSi1",
      "Cast iron EN-GJL-250", "Bronze CuSn8", "Messing", "Brass CuZn39Pb3", "Copper",
    ];
    for (const name of names) {
      expect(finishOf(name).metalness, name).toBeGreaterThan(0.5);
    }
  });

  it("is that of no metal for plastics, rubber and wood", () => {
    for (const name of ["ABS", "PA 6", "PA66-GF30", "POM", "NBR", "FKM 75", "EPDM", "Oak"]) {
      expect(finishOf(name).metalness, name).toBe(0);
    }
    expect(finishOf("NBR").roughness).toBeGreaterThan(finishOf("ABS").roughness);
  });

  it("is plain where nothing is known", () => {
    for (const name of ["", "Document", "Default", "Material 1"]) {
      expect(finishOf(name), name).toBe(kPlainFinish);
    }
  });

  it("comes back of its code as the shader decodes it, to the nearest fifteenth", () => {
    for (const finish of [kPlainFinish, finishOf("Steel"), finishOf("NBR"), { roughness: 1, metalness: 1 }]) {
      const code = encodeFinish(finish) - 1;
      expect((code % 16) / 15).toBeCloseTo(finish.roughness, 1);
      expect(Math.floor(code / 16) / 15).toBeCloseTo(finish.metalness, 1);
    }
  });
});
