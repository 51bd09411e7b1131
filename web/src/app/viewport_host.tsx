/** The picture. There is one of it on a page, whichever view shows it. */

import { useEffect, useRef } from "preact/hooks";
import { kNoRim, rimOf, type Rim } from "../model/framing";
import { SharedEyes } from "../view3d/shared_eyes";
import { Viewport } from "../view3d/viewport";
import { paths, studio, ui, view, viewport } from "./app_state";
import { language, t } from "./i18n";

const element = (() => {
  let made: HTMLDivElement | null = null;
  return () => {
    made ??= document.createElement("div");
    made.className = "viewport";
    return made;
  };
})();

/** What floats over the picture and stays there. */
const kPanels = ".tool-rail, .hint-bar, .guide, .model-panel, .inspector, .phone-sheet, .finish-card";

function coveredRim(): Rim {
  const workspace = element().closest(".workspace");
  const isHalved = view.stereo.peek() === "side";  // each eye has a half of the picture, and panels cover it as a whole
  if (workspace === null || isHalved) {
    return kNoRim;
  }
  const picture = element().getBoundingClientRect();
  const panels = [...workspace.querySelectorAll(kPanels)].map((panel) => panel.getBoundingClientRect());
  return rimOf(picture, panels.filter(({ width, height }) => width > 0 && height > 0));
}

/** What this page tells others of its view; null before there is one. */
let sharedEyes: SharedEyes | null = null;

function makeViewport(): Viewport {
  const made = new Viewport(element(), studio, view);
  made.rig.rim = coveredRim;
  made.canvas.tabIndex = 0;
  made.canvas.setAttribute("role", "application");
  made.pointer.onContextMenu = (x, y, hit) => {
    if (studio.study.isParticipantView.value) {
      return;
    }
    if (hit !== null && !view.selected.value.includes(hit.occurrence)) {
      view.selected.value = [hit.occurrence];
    }
    ui.overlay.value = { kind: "menu", x, y, occurrence: hit?.occurrence ?? null };
  };
  made.showPaths(paths);
  sharedEyes = new SharedEyes(made, studio);
  return made;
}

// While the page is worked on, the view of the module before does not go on beside the new one.
import.meta.hot?.dispose(() => {
  sharedEyes?.dispose();
  viewport.peek()?.dispose();
  viewport.value = null;
});

export function ViewportHost() {
  const host = useRef<HTMLDivElement>(null);
  useEffect(() => {
    host.current?.append(element());
    viewport.value ??= makeViewport();
  }, []);
  const isDark = view.isDark.value;
  const words = language.value;
  const port = viewport.value;
  useEffect(() => {
    port?.refreshTheme([
      t("cube.right"),
      t("cube.left"),
      t("cube.back"),
      t("cube.front"),
      t("cube.top"),
      t("cube.bottom"),
    ]);
  }, [isDark, words, port]);
  useEffect(() => port?.canvas.setAttribute("aria-label", t("view.label")), [port, words]);
  return <div class="viewport-host" ref={host} />;
}
