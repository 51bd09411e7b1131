/** Words and numbers in the language of the user. */

import { signal } from "@preact/signals";
import { de } from "./de";
import { en, type MessageKey } from "./en";

export const catalogues = { en, de } as const;
export type Language = keyof typeof catalogues;
export const languageNames: Record<Language, string> = { en: "English", de: "Deutsch" };

export const language = signal<Language>("en");

export type Params = Readonly<Record<string, string | number>>;

export function pickLanguage(wanted: string | null, offered: readonly string[]): Language {
  const candidates = [wanted ?? "", ...offered].map((tag) => tag.slice(0, 2).toLowerCase());
  return candidates.find((tag): tag is Language => tag in catalogues) ?? "en";
}

function fill(text: string, params: Params): string {
  return text.replace(/\{(\w+)\}/g, (whole, name: string) => {
    const value = params[name];
    return value === undefined ? whole : typeof value === "number" ? number(value) : value;
  });
}

export function t(key: MessageKey, params: Params = {}): string {
  return fill(catalogues[language.value][key], params);
}

type PluralStem = { [K in MessageKey]: K extends `${infer S}.one` ? S : never }[MessageKey];

export function tn(stem: PluralStem, n: number): string {
  const form = new Intl.PluralRules(language.value).select(n) === "one" ? "one" : "other";
  return t(`${stem}.${form}`, { n });
}

const formats = new Map<string, Intl.NumberFormat>();

/** With `digits` behind the point, or as many as it takes. */
export function number(value: number, digits?: number): string {
  const key = `${language.value}/${digits}`;
  let format = formats.get(key);
  if (format === undefined) {
    format = new Intl.NumberFormat(
      language.value,
      digits === undefined
        ? { maximumFractionDigits: 2 }
        : { minimumFractionDigits: digits, maximumFractionDigits: digits },
    );
    formats.set(key, format);
  }
  // No minus before a zero.
  return format.format(Math.abs(value) < 0.5 * Math.pow(10, -(digits ?? 2)) ? 0 : value);
}

/** As many digits as say something: for values that may be of any size. */
export function figures(value: number, digits = 3): string {
  const size = Math.abs(value);
  const decimals = size < 1e-6 ? digits - 1 : Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return number(value, Math.min(decimals, digits + 2));
}

/** Minutes and seconds, as 00:24.6. */
export function duration(seconds: number): string {
  const minutes = Math.floor(seconds / 60);
  return `${String(minutes).padStart(2, "0")}:${(seconds - 60 * minutes).toFixed(1).padStart(4, "0")}`;
}

/** Day and time, short. */
export function dateTime(unixMs: number): string {
  const format = new Intl.DateTimeFormat(language.value, { dateStyle: "medium", timeStyle: "short" });
  return format.format(new Date(unixMs));
}

export function megabytes(bytes: number): string {
  return `${number(bytes / 1e6, bytes < 1e7 ? 1 : 0)} MB`;
}
