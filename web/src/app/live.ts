/** Values that change sixty times a second, written past the components into the page. */

import { useEffect, useRef } from "preact/hooks";
import type { LiveState } from "../protocol/frame_store";
import type { HandState } from "../protocol/frames";
import { store, view, viewport } from "./app_state";
import { number } from "./i18n";

/** Ten times a second is as fast as people read. */
const kReadMs = 100;

export function useLive(write: (live: LiveState | null) => void, everyMs = kReadMs): void {
  const port = viewport.value;
  const latest = useRef(write);
  latest.current = write;
  useEffect(() => {
    let last = -Infinity;
    return port?.onFrame((live, now) => {
      if (now - last >= everyMs) {
        last = now;
        latest.current(live);
      }
    });
  }, [port, everyMs]);
}

/** The hand that holds something, or none; of several the one that has `wanted`, or that the mouse leads. */
export function holdingHand(live: LiveState | null, wanted: number | null = null): HandState | null {
  const holding = live?.hands.filter((h) => h.state > 0) ?? [];
  const ofWanted = wanted === null ? undefined : holding.find((h) => h.occurrence === wanted);
  return ofWanted ?? holding.find((h) => h.hand === view.hand.peek()) ?? holding[0] ?? null;
}

/** How old the newest state is that is drawn; a recording is as old as it is. */
export function ageText(live: LiveState | null): string {
  if (live === null || live.sentMs === 0 || store.replay.peek() !== null) {
    return "–";
  }
  return live.ageMs < 1000 ? `${number(live.ageMs, 1)} ms` : `${number(live.ageMs / 1000, 1)} s`;
}

/** Writes only what has changed: the page is not laid out anew for nothing. */
export function setText(element: Element | null, text: string): void {
  if (element !== null && element.textContent !== text) {
    element.textContent = text;
  }
}
