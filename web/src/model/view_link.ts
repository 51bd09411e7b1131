/** A view as text for the address bar: what is seen, from where, and what is marked. */

import type { Vec3 } from "./math";

export interface SectionPlane {
  axis: 0 | 1 | 2;
  /** From the middle of the product, as a share of its radius. */
  offset: number;
  isFlipped: boolean;
}

export interface SharedView {
  eye: Vec3;
  target: Vec3;
  isOrthographic: boolean;
  hidden: number[];
  ghosted: number[];
  selected: number[];
  explode: number;
  section: SectionPlane | null;
}

function numbers(text: string | null): number[] {
  return text === null || text === "" ? [] : text.split(",").map(Number).filter(Number.isFinite);
}

function short(values: readonly number[], digits: number): string {
  return values.map((v) => Number(v.toFixed(digits))).join(",");
}

export function encodeView(view: SharedView): string {
  const fields = new URLSearchParams();
  fields.set("eye", short(view.eye, 5));
  fields.set("to", short(view.target, 5));
  if (view.isOrthographic) {
    fields.set("ortho", "1");
  }
  for (const [key, ids] of [["hide", view.hidden], ["ghost", view.ghosted], ["sel", view.selected]] as const) {
    if (ids.length > 0) {
      fields.set(key, short(ids, 0));
    }
  }
  if (view.explode > 0) {
    fields.set("explode", view.explode.toFixed(2));
  }
  if (view.section !== null) {
    fields.set("cut", short([view.section.axis, view.section.offset, view.section.isFlipped ? 1 : 0], 5));
  }
  return `view&${fields.toString().replaceAll("%2C", ",")}`;
}

/** Null when the fragment is not of a view. */
export function decodeView(fragment: string): SharedView | null {
  const text = fragment.replace(/^#/, "");
  if (!text.startsWith("view&")) {
    return null;
  }
  const fields = new URLSearchParams(text.slice("view&".length));
  const eye = numbers(fields.get("eye"));
  const target = numbers(fields.get("to"));
  if (eye.length !== 3 || target.length !== 3) {
    return null;
  }
  const cut = numbers(fields.get("cut"));
  const axis = cut[0];
  return {
    eye: eye as unknown as Vec3,
    target: target as unknown as Vec3,
    isOrthographic: fields.get("ortho") === "1",
    hidden: numbers(fields.get("hide")),
    ghosted: numbers(fields.get("ghost")),
    selected: numbers(fields.get("sel")),
    explode: Math.min(1, Math.max(0, Number(fields.get("explode") ?? 0) || 0)),
    section:
      axis === 0 || axis === 1 || axis === 2
        ? { axis, offset: Math.min(1, Math.max(-1, cut[1] ?? 0)), isFlipped: cut[2] === 1 }
        : null,
  };
}

/** A moment of a recording. */
export interface Moment {
  recording: string;
  timeS: number;
}

export function encodeMoment(moment: Moment): string {
  return `&rec=${encodeURIComponent(moment.recording)}&at=${Number(moment.timeS.toFixed(3))}`;
}

/** The fragment of a link that lets somebody in, and shows what the other fragment stands for. */
export function withToken(token: string, fragment: string): string {
  return `t=${token}${fragment === "" ? "" : `&${fragment}`}`;
}

/** The token of a fragment, and what is left without it. */
export function takeToken(fragment: string): { token: string | null; rest: string } {
  const match = /^#?t=([\w-]+)(?:&(.*))?$/.exec(fragment);
  return match === null ? { token: null, rest: fragment.replace(/^#/, "") } : { token: match[1] ?? null, rest: match[2] ?? "" };
}

/** Of the fragment of a view; null when it has none. */
export function decodeMoment(fragment: string): Moment | null {
  const fields = new URLSearchParams(fragment.replace(/^#/, ""));
  const recording = fields.get("rec");
  const timeS = Number(fields.get("at") ?? 0);
  return recording === null || !(timeS >= 0) ? null : { recording, timeS };
}
