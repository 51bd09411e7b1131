/** Everything that can be done, once: menus, palette, tools, keys and the right-click menu show the same. */

import { clearPicks, isolate, select, setHidden, showAll, toggleGhost, type Tool } from "../model/view_state";
import { handToJoin } from "../model/people";
import type { PathKind } from "../model/part_path";
import type { ViewName } from "../view3d/camera_rig";
import { canSteer, leadsHand, paths, store, studio, ui, view, viewport } from "./app_state";
import { chooseFile, saveRuns, saveScreenshot } from "./exports";
import { t } from "./i18n";
import type { MessageKey } from "./en";
import type { CommandResults } from "../protocol/messages";
import { action, toggle, type Action } from "./action";
import { forcesOff, kStopKey, takeChosen } from "./hand_actions";
import { fileTimeActions, simulateTimeActions, timeActions } from "./time_actions";
import { enterVr } from "./vr_entry";

const hasScene = () => store.scene.value !== null;
const chosen = () => view.selected.value;
const hasChosen = () => hasScene() && chosen().length > 0;
const hasOneChosen = () => hasScene() && chosen().length === 1;
const steers = () => hasScene() && canSteer();
const isHolding = () => store.held.value.some((h) => h.hand === view.hand.value);

function tool(name: Tool, id: string, label: MessageKey, key: string): Action {
  return action(id, label, () => setTool(name), {
    keys: [key],
    isEnabled: hasScene,
    isOn: () => view.tool.value === name,
  });
}

export function setTool(name: Tool): void {
  clearPicks(view);
  view.tool.value = view.tool.value === name && name !== "hand" ? "hand" : name;
}

function standardView(name: ViewName, label: MessageKey, key: string): Action {
  return action(`view-${name}`, label, () => viewport.value?.lookFrom(name), { keys: [key], isEnabled: hasScene });
}

/** Nobody takes the hand of a study's participant. */
const mayAskForLease = () =>
  store.link.value === "open" && !store.hasLease.value && store.role.value === "operator" && store.study.value === null;

async function askForLease(): Promise<void> {
  noteAsked(await studio.command({ command: "lease", action: "request" }));
}

/** For a hand of one's own beside that of whoever steers. */
async function askToJoin(): Promise<void> {
  noteAsked(await studio.command({ command: "lease", action: "request", hand: handToJoin(store.hands.value, store.clients.value) }));
}

function noteAsked(answer: CommandResults["lease"] | null): void {
  if (answer?.waits_for !== undefined) {
    studio.notify(t("notice.leaseAsked"));
  }
}

/** To whoever asked for it; a hand that is not there yet is made. */
async function giveLease(): Promise<void> {
  const asked = store.leaseAsked.value;
  if (asked === null) {
    return;
  }
  const count = Math.min(...asked.hands) + 1;
  if (count > store.hands.value.length && (await studio.command({ command: "hands", count })) === null) {
    return;
  }
  for (const hand of asked.hands.filter((each) => store.ownHands.value.includes(each))) {
    void studio.command({ command: "lease", action: "give", to: asked.by, hand });
  }
}

const fileActions: Action[] = [
  action("open", "action.open", chooseFile, { keys: ["ctrl+o"], isEnabled: canSteer }),
  action("screenshot", "action.screenshot", () => void saveScreenshot(), { startsGroup: true, isEnabled: hasScene }),
  action("share", "action.share", () => (ui.overlay.value = { kind: "share" }), { isEnabled: () => store.link.value === "open" }),
  action("runs", "action.runs", saveRuns, { isEnabled: () => store.runs.value.length > 0 }),
  ...fileTimeActions,
];

const editActions: Action[] = [
  action(
    "undo",
    () => (store.history.value.undo ? t("action.undoWhat", { what: store.history.value.undo }) : t("action.undo")),
    () => void studio.command({ command: "undo" }),
    { keys: ["ctrl+z"], isEnabled: () => canSteer() && store.history.value.undo !== null },
  ),
  action(
    "redo",
    () => (store.history.value.redo ? t("action.redoWhat", { what: store.history.value.redo }) : t("action.redo")),
    () => void studio.command({ command: "redo" }),
    { keys: ["ctrl+y", "ctrl+shift+z"], isEnabled: () => canSteer() && store.history.value.redo !== null },
  ),
  action("select-all", "action.selectAll", () => select(view, [...store.occurrences.value.keys()], false), {
    startsGroup: true,
    keys: ["ctrl+a"],
    isEnabled: hasScene,
  }),
  action("select-none", "action.selectNone", () => select(view, [], false), { isEnabled: hasChosen }),
  action(
    "find",
    "action.find",
    () => {
      ui.panels.model.value = true;
      ui.phoneSheet.value = "parts";
      ui.findRequest.value += 1;
    },
    { keys: ["/"], isEnabled: hasScene },
  ),
];

const viewActions: Action[] = [
  action("fit", "action.fit", () => viewport.value?.fit(chosen()), { keys: ["f"], isEnabled: hasScene }),
  standardView("front", "action.viewFront", "1"),
  standardView("back", "action.viewBack", "2"),
  standardView("left", "action.viewLeft", "3"),
  standardView("right", "action.viewRight", "4"),
  standardView("top", "action.viewTop", "5"),
  standardView("bottom", "action.viewBottom", "6"),
  standardView("iso", "action.viewIso", "7"),
  action("views", "action.views", () => (ui.overlay.value = { kind: "views" }), { isEnabled: hasScene }),
  toggle("follow-steps", "action.followSteps", view.followsSteps),
  toggle("ortho", "action.ortho", view.isOrthographic, { keys: ["p"] }),
  action("hide", "action.hide", () => setHidden(view, chosen(), true), {
    keys: ["h"],
    isEnabled: hasChosen,
    startsGroup: true,
  }),
  action("isolate", "action.isolate", () => isolate(view, chosen(), [...store.occurrences.value.keys()]), {
    keys: ["i"],
    isEnabled: hasChosen,
  }),
  action("ghost", "action.ghost", () => toggleGhost(view, chosen()), {
    keys: ["t"],
    isEnabled: hasChosen,
    isOn: () => hasChosen() && chosen().every((id) => view.ghosted.value.has(id)),
  }),
  action("show-all", "action.showAll", () => showAll(view), {
    keys: ["a"],
    isEnabled: () => view.hidden.value.size + view.ghosted.value.size > 0,
  }),
  action("path-points", "action.pathPoints", () => showPath("points"), { isEnabled: hasOneChosen, startsGroup: true }),
  action("path-swept", "action.pathSwept", () => showPath("swept"), { isEnabled: hasOneChosen }),
  action("note", "action.note", () => (ui.overlay.value = { kind: "note" }), {
    isEnabled: () => hasOneChosen() && store.role.value === "operator" && store.study.value === null && store.replay.value === null,
  }),
  action("section", "action.section", toggleSection, {
    startsGroup: true,
    keys: ["x"],
    isEnabled: hasScene,
    isOn: () => view.section.value !== null,
  }),
  action("explode", "action.explode", toggleExplode, { keys: ["b"], isEnabled: hasScene, isOn: () => view.explode.value > 0 }),
  action("apart", "action.apart", toggleApart, { keys: ["j"], isEnabled: hasScene, isOn: () => view.apart.value !== null }),
  toggle("edges", "action.edges", view.showsEdges, { startsGroup: true }),
  toggle("grid", "action.grid", view.showsGrid),
  action("workshop", "action.workshop", toggleWorkshop, { keys: ["u"], isOn: () => view.drawsWorkshop.value }),
  toggle("forces-shown", "action.forcesShown", view.showsForces),
  toggle("force-scale", "action.forceScale", view.locksForceScale),
  action("quality", "action.quality", toggleQuality, { isOn: () => view.isFine.value, startsGroup: true }),
  action("stereo-side", "action.stereoSide", () => toggleStereo("side"), { isOn: () => view.stereo.value === "side" }),
  action("stereo-anaglyph", "action.stereoAnaglyph", () => toggleStereo("anaglyph"), {
    isOn: () => view.stereo.value === "anaglyph",
  }),
  toggle("panel-model", "action.panelModel", ui.panels.model, { startsGroup: true }),
  toggle("panel-inspector", "action.panelInspector", ui.panels.inspector),
  toggle("panel-plots", "action.panelPlots", ui.panels.plots),
  action("theme", "action.theme", () => (view.theme.value = view.isDark.value ? "light" : "dark"), { keys: ["l"] }),
  action("theme-system", "action.themeSystem", () => (view.theme.value = "system"), {
    isOn: () => view.theme.value === "system",
  }),
];

const toolActions: Action[] = [
  tool("hand", "tool-hand", "action.toolHand", "v"),
  tool("select", "tool-select", "action.toolSelect", "s"),
  tool("measure", "tool-measure", "action.toolMeasure", "m"),
  tool("mate", "tool-mate", "action.toolMate", "c"),
  ...(["part", "subassembly", "face"] as const).map((mode) =>
    action(
      `mode-${mode}`,
      (
        {
          part: "action.modePart",
          subassembly: "action.modeSubassembly",
          face: "action.modeFace",
        } as const
      )[mode],
      () => (view.selectMode.value = mode),
      { isEnabled: hasScene, isOn: () => view.selectMode.value === mode },
    ),
  ),
];

const simulateActions: Action[] = [
  action("take", "action.take", takeChosen, { startsGroup: true, keys: ["g"], isEnabled: () => hasScene() && leadsHand() && !isHolding() }),
  action("release", "action.release", () => viewport.value?.hand.release(), {
    keys: ["r"],
    isEnabled: () => isHolding() && leadsHand() && !store.demo.value,
  }),
  action("align", "action.align", () => viewport.value?.hand.mouse.snapTurn(), { keys: ["o"], isEnabled: isHolding }),
  toggle("assist", "action.assist", view.assists),
  toggle("auto-release", "action.autoRelease", view.letsGoWhenSeated),
  action(
    "demo",
    () => t(store.demo.value ? "action.demoStop" : "action.demo"),
    () => void studio.command({ command: "demo", on: !store.demo.value }),
    { startsGroup: true, keys: ["d"], isEnabled: steers, isOn: () => store.demo.value },
  ),
  action("next", "action.next", () => void studio.command({ command: "next" }), {
    keys: ["n"],
    isEnabled: () => steers() && !store.demo.value,
  }),
  action("reset", "action.reset", () => void studio.command({ command: "reset" }), { isEnabled: steers }),
  action("forces-off", "action.forcesOff", forcesOff, { startsGroup: true, keys: [kStopKey] }),
  action("forces-on", "action.forcesOn", () => void studio.command({ command: "forces", off: false }), {
    isEnabled: () => canSteer() && store.forcesOff.value,
  }),
  ...simulateTimeActions,
  toggle("mute", "action.mute", view.isMuted, { startsGroup: true }),
  action("lease", "action.lease", () => void askForLease(), {
    isEnabled: mayAskForLease,
  }),
  action("join", "action.join", () => void askToJoin(), {
    isEnabled: () => mayAskForLease() && store.ownHands.value.every((hand) => hand >= store.hands.value.length),
  }),
  action("lease-give", "action.leaseGive", () => void giveLease(), { isEnabled: () => store.leaseAsked.value !== null }),
  action("lease-release", "action.leaseRelease", () => void studio.command({ command: "lease", action: "release" }), {
    isEnabled: () => store.hasLease.value && store.clients.value.length > 1,
  }),
  action("enter-vr", () => t(ui.isInVr.value ? "action.leaveVr" : "action.enterVr"), () => void enterVr((id) => runAction(findAction(id))), {
    isEnabled: hasScene,
  }),
];

const helpActions: Action[] = [
  action("palette", "action.palette", () => (ui.overlay.value = { kind: "palette" }), { keys: ["ctrl+k"] }),
  action("shortcuts", "action.shortcuts", () => (ui.overlay.value = { kind: "shortcuts" }), { keys: ["?"] }),
  toggle("single-keys", "action.singleKeys", view.hasSingleKeys),
  toggle("guide", "action.guide", view.guidesFirstPart),
];

function showPath(kind: PathKind): void {
  const [occurrence] = chosen();
  if (occurrence !== undefined) {
    void paths.show(occurrence, kind);
  }
}

function toggleSection(): void {
  view.section.value = view.section.value === null ? { axis: 0, offset: 0, isFlipped: false } : null;
}

function toggleExplode(): void {
  view.apart.value = null;
  view.explode.value = view.explode.value > 0 ? 0 : 0.6;
}

function toggleApart(): void {
  view.explode.value = 0;
  view.apart.value = view.apart.value === null ? 0 : null;
}

function toggleWorkshop(): void {
  if (view.drawsWorkshop.value) {
    view.showsWorkshop.value = false;
    return;
  }
  view.showsWorkshop.value = view.editsBench.value = true;
  if (!view.drawsWorkshop.value) {
    // Whoever asks for it gets it, on a slow machine as well.
    view.quality.value = "high";
  }
}

function toggleQuality(): void {
  view.quality.value = view.isFine.value ? "low" : "high";
}

function toggleStereo(wanted: "side" | "anaglyph"): void {
  view.stereo.value = view.stereo.value === wanted ? "none" : wanted;
  if (view.stereo.value !== "none") {
    view.isOrthographic.value = false;
  }
}

export const menus: readonly { id: MessageKey; actions: readonly Action[] }[] = [
  { id: "menu.file", actions: fileActions },
  { id: "menu.edit", actions: editActions },
  { id: "menu.view", actions: viewActions },
  { id: "menu.simulate", actions: [...toolActions, ...simulateActions] },
  { id: "menu.record", actions: timeActions },
  { id: "menu.help", actions: helpActions },
];

export const actions: readonly Action[] = menus.flatMap((menu) => menu.actions);
const byId = new Map(actions.map((a) => [a.id, a]));

export function findAction(id: string): Action {
  const found = byId.get(id);
  if (found === undefined) {
    throw new Error(`no action ${id}`);
  }
  return found;
}

export const isEnabled = (a: Action) => a.isEnabled?.() ?? true;

export function runAction(a: Action): void {
  if (isEnabled(a)) {
    a.run();
  }
}
