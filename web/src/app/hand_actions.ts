/** Taking parts, and no force any more. */

import { store, studio, view, viewport } from "./app_state";
import { t } from "./i18n";

/** No character, so that it also works where something is typed. */
export const kStopKey = "f8";

/** Always works, whoever has control: no force any more, at once. */
export function forcesOff(): void {
  void studio.command({ command: "forces", off: true });
  viewport.value?.hand.releaseAll();
}

/** Into the hand, and the picture has the keys. */
async function takePart(wanted: number | undefined): Promise<void> {
  if (wanted === undefined) {
    studio.notify(t("notice.notHeld"));
  } else if (await viewport.value?.hand.take(wanted)) {
    focusPicture();
  }
}

export function takeChosen(): void {
  void takePart(view.hovered.value ?? view.selected.value[0] ?? store.expected.value?.occurrence);
}

/** What is selected, where it is loose; else the part whose turn it is. */
export function takeNext(): void {
  const loose = view.selected.value.find((id) => store.placements.value.get(id) === "loose");
  void takePart(loose ?? store.expected.value?.occurrence);
}

/** The keys are the picture's. */
export function focusPicture(): void {
  viewport.value?.canvas.focus({ preventScroll: true });
}
