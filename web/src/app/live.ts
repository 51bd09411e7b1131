/** Values that change sixty times a second, written past the components into the page. */

import { useEffect, useRef } from "preact/hooks";
import type { LiveState } from "../protocol/frame_store";
import type { HandState } from "../protocol/frames";
import { viewport } from "./app_state";

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

/** The hand that holds something, or none. */
export function holdingHand(live: LiveState | null): HandState | null {
  return live?.hands.find((h) => h.state > 0) ?? null;
}

/** Writes only what has changed: the page is not laid out anew for nothing. */
export function setText(element: Element | null, text: string): void {
  if (element !== null && element.textContent !== text) {
    element.textContent = text;
  }
}
