/** What is seen and from where, as a whole: to share it, to keep it, and to come back to it. */

import type { SharedView } from "../model/view_link";
import type { ViewState } from "../model/view_state";
import type { CameraRig } from "./camera_rig";

export function readView(view: ViewState, rig: CameraRig): SharedView {
  return {
    ...rig.pose(),
    isOrthographic: view.isOrthographic.value,
    hidden: [...view.hidden.value],
    ghosted: [...view.ghosted.value],
    selected: [...view.selected.value],
    explode: view.explode.value,
    section: view.section.value,
  };
}

export function applyView(shared: SharedView, view: ViewState, rig: CameraRig): void {
  view.hidden.value = new Set(shared.hidden);
  view.ghosted.value = new Set(shared.ghosted);
  view.selected.value = shared.selected;
  view.explode.value = shared.explode;
  view.section.value = shared.section;
  view.isOrthographic.value = shared.isOrthographic;
  rig.setPose(shared.eye, shared.target);
}
