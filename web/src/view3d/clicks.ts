/** A click on the view: it selects parts, groups and faces, and picks the faces that a tool asks for. */

import { togetherWith } from "../model/store";
import type { Studio } from "../model/studio";
import { groupAround } from "../model/tree";
import { select, type ViewState } from "../model/view_state";
import type { FaceOf } from "../protocol/messages";
import type { PickHit } from "./parts";
import type { SceneView } from "./scene_view";

/** What is clicked on. */
interface ClickedView {
  readonly view: ViewState;
  readonly product: SceneView;
}

export class Clicks {
  constructor(
    private readonly viewport: ClickedView,
    private readonly studio: Studio,
  ) {}

  click(event: PointerEvent, hit: PickHit | null): void {
    const { view } = this.viewport;
    const tool = view.tool.peek();
    view.clickedAt.value = hit === null ? null : { occurrence: hit.occurrence, p_W: [hit.point.x, hit.point.y, hit.point.z] };
    if (tool === "measure" || tool === "mate") {
      if (hit !== null) {
        this.pickFace({ occurrence: hit.occurrence, face: hit.face });
      }
      return;
    }
    const isAdding = event.ctrlKey || event.metaKey || event.shiftKey;
    if (hit === null) {
      if (!isAdding) {
        select(view, [], false);
      }
      return;
    }
    const mode = view.selectMode.peek();
    const scene = this.viewport.product.scene;
    if (mode === "subassembly" && scene !== null) {
      select(view, groupAround(scene, hit.occurrence, view.selected.peek()), isAdding);
      return;
    }
    select(view, event.altKey ? [hit.occurrence] : togetherWith(this.studio.store.leaders.peek(), hit.occurrence), isAdding);
    if (mode === "face") {
      view.selectedFace.value = { occurrence: hit.occurrence, face: hit.face };
    }
  }

  private pickFace(face: FaceOf): void {
    const { view } = this.viewport;
    const picked = view.picked.peek();
    const next = picked.length >= 2 ? [face] : [...picked, face];
    view.picked.value = next;
    if (view.tool.peek() === "measure") {
      void this.measure(next);
    }
  }

  private async measure(faces: readonly FaceOf[]): Promise<void> {
    const [a, b] = faces;
    if (a !== undefined) {
      this.viewport.view.measurement.value = await this.studio.command(
        b === undefined ? { command: "measure", a } : { command: "measure", a, b },
      );
    }
  }
}
