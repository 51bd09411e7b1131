/** What every participant sees alike, whatever was set up in this browser before. */

import { effect, untracked } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { clearPicks, showAll } from "../../model/view_state";
import { store, studio, ui, view, viewport } from "../app_state";
import { language, pickLanguage } from "../i18n";

/** No arrows and no sounds of forces: a fit is told by the hand alone. The sound at the end is the protocol's choice. No
 help of the page's own either: what guides the part is what the condition says. */
function setUpView(): void {
  view.showsForces.value = false;
  view.hasOnlyEndSound.value = true;
  view.assists.value = false;
  view.letsGoWhenSeated.value = true;
  view.showsWorkshop.value = false;
  view.reflects.value = false;
  view.showsCube.value = false;
  view.showsEdges.value = true;
  view.showsGrid.value = true;
  view.isOrthographic.value = false;
  view.section.value = null;
  view.explode.value = 0;
  view.apart.value = null;
  view.selectMode.value = "part";
  ui.overlay.value = null;
}

/** Each trial begins with the same picture. */
function beginTask(): void {
  view.selected.value = [];
  showAll(view);
  clearPicks(view);
  viewport.peek()?.lookAnew();
}

function setResting(isResting: boolean): void {
  const port = viewport.value;
  if (port !== null) {
    port.isResting = isResting;
    port.invalidate();
  }
}

/** Two faces that are picked are what is sent. */
function sendPicks(onPicked: (isSet: boolean) => void): void {
  const [a, b] = view.picked.value;
  if (studio.study.isPicking.peek() && a !== undefined && b !== undefined) {
    clearPicks(view);
    void studio.study.pick(a, b).then(onPicked);
  }
}

export function useParticipantSetup(onPicked: (isSet: boolean) => void): void {
  useEffect(() => {
    setUpView();
    const stops = [
      effect(() => {
        const spoken = studio.study.language.value;
        if (spoken !== null) {
          language.value = pickLanguage(spoken, navigator.languages);
        }
      }),
      effect(() => {
        const state = studio.study.state.value;
        view.isMuted.value = !(state?.has_end_sound ?? false);
        view.stereo.value = state?.stereo ?? "none";
      }),
      effect(() => {
        if (studio.study.isTask.value && store.scene.value !== null) {
          untracked(beginTask);
        }
      }),
      effect(() => {
        if (studio.study.isTask.value) {
          view.tool.value = studio.study.isPicking.value ? "mate" : "hand";
        }
      }),
      effect(() => sendPicks(onPicked)),
      effect(() => setResting(!studio.study.isTask.value)),
    ];
    return () => {
      stops.forEach((stop) => stop());
      setResting(false);
    };
  }, []);
}
