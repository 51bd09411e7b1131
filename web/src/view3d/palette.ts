/** Colours of the 3D view, read from the page's style: a canvas does not follow CSS variables. */

import { Color } from "three";

export interface Palette {
  edge: Color;
  edgeMarked: Color;
  grid: Color;
  hover: Color;
  selected: Color;
  held: Color;
  expected: Color;
  goal: Color;
  force: Color;
  torque: Color;
  contact: Color;
  axis: Color;
  cap: Color;
  face: Color;
  measure: Color;
  path: Color;
  cubeFace: string;
  cubeInk: string;
  cubeEdge: string;
  isDark: boolean;
}

export function readPalette(element: Element): Palette {
  const style = getComputedStyle(element);
  const text = (name: string) => style.getPropertyValue(name).trim();
  const color = (name: string) => new Color(text(name) || "#888888");
  return {
    edge: color("--v-edge"),
    edgeMarked: color("--v-edge-marked"),
    grid: color("--v-grid"),
    hover: color("--v-hover"),
    selected: color("--v-selected"),
    held: color("--v-held"),
    expected: color("--v-expected"),
    goal: color("--v-goal"),
    force: color("--s-red"),
    torque: color("--s-orange"),
    contact: color("--v-contact"),
    axis: color("--v-axis"),
    cap: color("--v-cap"),
    face: color("--v-face"),
    measure: color("--v-measure"),
    path: color("--v-path"),
    cubeFace: text("--v-cube-face"),
    cubeInk: text("--v-cube-ink"),
    cubeEdge: text("--v-cube-edge"),
    isDark: text("--v-dark") === "1",
  };
}
