/** What a link asked for: a view, and a moment of a recording. */

import { effect } from "@preact/signals";
import type { Moment, SharedView } from "../model/view_link";
import { store, viewport } from "./app_state";
import { openRecording } from "./time_source";

/** The view is that of the recording, so it waits until the recording stands there. */
function showWhenLoaded(view: SharedView): void {
  const port = viewport.peek();
  const stop = port?.onFrame(() => {
    if (port.product.scene !== null && port.product.scene.epoch === store.scene.peek()?.epoch) {
      stop?.();
      port.show(view);
    }
  });
}

export function showShared(view: SharedView | null, moment: Moment | null): void {
  let isDone = false;
  effect(() => {
    const port = viewport.value;
    const isOpen = store.link.value === "open";
    if (isDone || view === null || port === null) {
      return;
    }
    if (moment === null) {
      isDone = true;
      port.show(view);
    } else if (isOpen) {
      isDone = true;
      void openRecording(moment.recording, moment.timeS).then(() => showWhenLoaded(view));
    }
  });
}
