import { afterEach, describe, expect, it } from "vitest";
import { catalogues, duration, figures, language, number, pickLanguage, t, tn } from "../src/app/i18n";

afterEach(() => {
  language.value = "en";
});

const placeholders = (text: string) => [...text.matchAll(/\{(\w+)\}/g)].map((m) => m[1]).sort();

describe("the catalogues", () => {
  it("have the same keys", () => {
    expect(Object.keys(catalogues.de).sort()).toEqual(Object.keys(catalogues.en).sort());
  });

  it("have the same places for values, and no empty text", () => {
    for (const [key, text] of Object.entries(catalogues.en)) {
      const german = catalogues.de[key as keyof typeof catalogues.en];
      expect(placeholders(german), key).toEqual(placeholders(text));
      expect(german.trim(), key).not.toBe("");
    }
  });
});

describe("words and numbers", () => {
  it("follow the language", () => {
    expect(t("hint.near", { into: "bore" })).toBe("Close to bore. Line it up.");
    language.value = "de";
    expect(tn("tree.title", 1)).toBe("Modell · 1 Teil");
    expect(tn("tree.title", 3)).toBe("Modell · 3 Teile");
    expect(number(1234.5, 1)).toBe("1.234,5");
  });

  it("have no minus before a zero", () => {
    expect(number(-0.001, 2)).toBe("0.00");
  });

  it("have as many digits as say something", () => {
    expect(figures(1671.35)).toBe("1,671");
    expect(figures(4.6321)).toBe("4.63");
    expect(figures(0.00278, 2)).toBe("0.0028");
    expect(figures(0)).toBe("0.00");
  });

  it("tell times as minutes and seconds", () => {
    expect(duration(84.62)).toBe("01:24.6");
  });

  it("take the first language that there is", () => {
    expect(pickLanguage(null, ["fr-FR", "de-AT", "en"])).toBe("de");
    expect(pickLanguage("en", ["de"])).toBe("en");
    expect(pickLanguage(null, ["ja"])).toBe("en");
  });
});
