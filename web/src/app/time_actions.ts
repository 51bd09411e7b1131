/** What can be done with time: record, play, go to a moment; and with hands and their devices. */

import { handAfter } from "../model/hands";
import { action, type Action } from "./action";
import { canSteer, store, studio, ui, view } from "./app_state";
import { savePlot } from "./exports";
import { t } from "./i18n";
import { backToLive, plotClock, seek } from "./time_source";

const playback = () => studio.recordings.playback.value;
const isPlayback = () => playback() !== null;
/** Where the thumb is on a mark, the next one is meant [s]. */
const kOnMarkS = 1e-3;

function togglePlay(): void {
  const shown = playback();
  if (shown?.isPlaying.value) {
    shown.pause();
  } else {
    shown?.play();
  }
}

/** To the next event, or the one before. */
function goToMark(direction: 1 | -1): void {
  const shown = playback();
  const ahead = (shown?.marks ?? []).filter((mark) => direction * (mark.timeS - (shown?.timeS ?? 0)) > kOnMarkS);
  const next = direction > 0 ? ahead[0] : ahead.at(-1);
  if (next !== undefined) {
    seek(next.timeS);
  }
}

function switchHand(): void {
  view.hand.value = handAfter(store.ownHands.value, view.hand.value);
  studio.notify(t("notice.hand", { n: view.hand.value + 1 }));
}

export const fileTimeActions: Action[] = [action("plot-csv", "action.plotCsv", savePlot)];

export const simulateTimeActions: Action[] = [
  action("switch-hand", "action.switchHand", switchHand, {
    keys: ["w"],
    isEnabled: () => canSteer() && store.ownHands.value.length > 1,
  }),
  action("devices", "action.devices", () => (ui.overlay.value = { kind: "devices" }), {
    isEnabled: () => store.link.value === "open",
  }),
];

export const timeActions: Action[] = [
  action(
    "record",
    () => t(store.recording.value === null ? "action.record" : "action.recordStop"),
    () => void studio.command({ command: "record", on: store.recording.value === null }),
    {
      keys: ["k"],
      isEnabled: () => store.hasLease.value && store.link.value === "open" && store.live.scene.value !== null,
      isOn: () => store.recording.value !== null,
    },
  ),
  action("recordings", "action.recordings", () => (ui.overlay.value = { kind: "recordings" }), {
    isEnabled: () => store.link.value === "open",
  }),
  action("compare", "action.compare", () => {
    ui.panels.plots.value = true;
    ui.bottomTab.value = "compare";
  }),
  action(
    "play",
    () => t(playback()?.isPlaying.value ? "action.pause" : "action.play"),
    togglePlay,
    { startsGroup: true, keys: [" "], isEnabled: isPlayback },
  ),
  action("play-start", "action.playStart", () => seek(plotClock().beginS), { isEnabled: isPlayback }),
  action("play-end", "action.playEnd", () => seek(plotClock().endS), { isEnabled: isPlayback }),
  action("frame-back", "action.frameBack", () => playback()?.stepFrames(-1), { keys: [","], isEnabled: isPlayback }),
  action("frame-on", "action.frameOn", () => playback()?.stepFrames(1), { keys: ["."], isEnabled: isPlayback }),
  action("mark-back", "action.markBack", () => goToMark(-1), { keys: ["["], isEnabled: isPlayback }),
  action("mark-on", "action.markOn", () => goToMark(1), { keys: ["]"], isEnabled: isPlayback }),
  action("live", "action.live", backToLive, { isEnabled: () => isPlayback() || ui.plotSpan.value !== null }),
];
