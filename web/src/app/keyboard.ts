/** Keys: the shortcuts of the actions, those that move what is in the hand, and those of the picture. */

import { actions, findAction, runAction } from "./actions";
import { focusPicture, forcesOff, kStopKey, takeNext } from "./hand_actions";
import { isCharacterKey } from "./key";
import { clearPicks, select } from "../model/view_state";
import { paths, store, studio, ui, view, viewport } from "./app_state";

const kNudgePx = 6;
/** What an arrow key turns the view by where nothing is in the hand [rad], and Page Up brings it nearer. */
const kLookStep = Math.PI / 24;
const kNearer = 0.85;
/** Less is no force that anybody would feel [N]. */
const kLeastForce = 0.02;

const byKey = new Map(actions.flatMap((a) => (a.keys ?? []).map((key) => [key, a] as const)));

function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName));
}

/** Within what has arrow keys of its own that it cannot do without. */
function ownsArrows(target: EventTarget | null): boolean {
  const kOwners = "dialog,.order,[role=menu],[role=listbox],[role=slider],[role=separator],[role=tablist]";
  return isTyping(target) || (target instanceof HTMLElement && target.closest(kOwners) !== null);
}

/** Keys of commands that a focused control needs for itself. */
function belongsToControl(event: KeyboardEvent): boolean {
  const presses = /^(Enter$| $)/.test(event.key);
  const owner = presses ? "button,[role=tree],[role=menu],[role=listbox]" : "[role=menu],[role=listbox]";
  return event.target instanceof HTMLElement && event.target.closest(owner) !== null;
}

const isOnPicture = () => document.activeElement === viewport.value?.canvas;
const isParticipant = () => studio.study.isParticipantView.value;

/** Any force, on any hand. */
function forceActs(): boolean {
  const hands = studio.liveFrames?.read()?.hands;
  return hands === undefined
    ? store.live.held.value.length > 0
    : hands.some((hand) => Math.hypot(...hand.f_felt_W_n) > kLeastForce);
}

/** What an arrow key moves the held part by [m]. */
export function keyStep(): number {
  const port = viewport.value;
  const held = port?.hand.mouse.occurrence ?? null;
  const at = port === null || held === null ? undefined : port.product.poseOf(held)?.p;
  if (view.keyMove.value > 0 || port === null) {
    return view.keyMove.value;
  }
  return kNudgePx * (at === undefined ? 1e-3 : port.eye.metresPerPixel(at));
}

function moveHeld(event: KeyboardEvent): boolean {
  const port = viewport.value;
  const held = port?.hand.mouse.occurrence ?? null;
  if (port === null || held === null) {
    return false;
  }
  const fine = event.altKey ? 0.2 : 1;
  const step = keyStep() * fine;
  const turn = view.keyTurn.value * fine;
  const { mouse } = port.hand;
  switch (event.key.toLowerCase()) {
    case "arrowleft":
      mouse.nudge(-step, 0, 0, port.eye);
      return true;
    case "arrowright":
      mouse.nudge(step, 0, 0, port.eye);
      return true;
    case "arrowup":
      mouse.nudge(0, step, 0, port.eye);
      return true;
    case "arrowdown":
      mouse.nudge(0, -step, 0, port.eye);
      return true;
    case "pageup":
      mouse.nudge(0, 0, step, port.eye);
      return true;
    case "pagedown":
      mouse.nudge(0, 0, -step, port.eye);
      return true;
    case "q":
      mouse.turn(0, 0, turn, port.eye);
      return true;
    case "e":
      mouse.turn(0, 0, -turn, port.eye);
      return true;
    default:
      return false;
  }
}

interface Closer {
  isOpen: () => boolean;
  close: () => void;
}

const flag = (signal: { value: boolean }): Closer => ({ isOpen: () => signal.value, close: () => (signal.value = false) });

/** What Escape closes, one at a time: what stands before all else, a search, a panel, a tool, the selection. */
const kClosers: readonly Closer[] = [
  { isOpen: () => ui.overlay.value !== null, close: () => (ui.overlay.value = null) },
  {
    isOpen: () => ui.treeSearch.value !== "" || isTyping(document.activeElement),
    close: () => {
      ui.treeSearch.value = "";
      focusPicture();
    },
  },
  { isOpen: () => paths.shown.value !== null, close: () => paths.hide() },
  flag(view.editsBench),
  { isOpen: () => view.apart.value !== null, close: () => (view.apart.value = null) },
  { isOpen: () => view.explode.value > 0, close: () => (view.explode.value = 0) },
  { isOpen: () => view.section.value !== null, close: () => (view.section.value = null) },
  {
    isOpen: () => view.picked.value.length > 0 || view.tool.value !== "hand",
    close: () => {
      clearPicks(view);
      view.tool.value = "hand";
    },
  },
  { isOpen: () => view.selected.value.length > 0, close: () => select(view, [], false) },
];

/** May this key move what is in the hand, wherever the focus is? */
function mayMove(event: KeyboardEvent): boolean {
  const isFree = !event.ctrlKey && !event.metaKey && ui.overlay.value === null && !ownsArrows(event.target);
  if (isParticipant()) {
    return isFree && studio.study.isTask.value;
  }
  return isFree && (view.hasSingleKeys.value || !isCharacterKey(event.key) || isOnPicture());
}

/** Before whatever has the focus: the stop, and what moves the part in the hand. */
function onKeyFirst(event: KeyboardEvent): void {
  const isEscape = event.key === "Escape" && (isParticipant() || forceActs());
  if (event.key.toLowerCase() === kStopKey || isEscape) {
    forcesOff();
  } else if (!mayMove(event) || !moveHeld(event)) {
    return;
  }
  event.preventDefault();
  event.stopPropagation();
}

/** The keys while the picture has the focus and nothing is in the hand: arrows look around; Enter takes and lets go. */
function onPictureKey(event: KeyboardEvent): boolean {
  const rig = viewport.value?.rig;
  if (rig === undefined || !isOnPicture() || event.ctrlKey || event.metaKey || event.altKey) {
    return false;
  }
  switch (event.key) {
    case "Enter":
      if (store.held.value.some((held) => held.hand === view.hand.value)) {
        runAction(findAction("release"));
      } else {
        takeNext();
      }
      return true;
    case "ArrowLeft":
      rig.turn(-kLookStep, 0);
      return true;
    case "ArrowRight":
      rig.turn(kLookStep, 0);
      return true;
    case "ArrowUp":
      rig.turn(0, -kLookStep);
      return true;
    case "ArrowDown":
      rig.turn(0, kLookStep);
      return true;
    case "PageUp":
      rig.approach(kNearer);
      return true;
    case "PageDown":
      rig.approach(1 / kNearer);
      return true;
    default:
      return false;
  }
}

/** The keys of a study: the hand, and the way out; no view, tool or help that others did not have. */
function onParticipantKey(event: KeyboardEvent): void {
  const { isPicking, isTask, state } = studio.study;
  const isOther = event.ctrlKey || event.metaKey || event.defaultPrevented || belongsToControl(event);
  if (!isTask.value || isOther || isTyping(event.target)) {
    return;
  }
  const wanted = state.value?.occurrence ?? null;
  const key = event.key.toLowerCase();
  if (key === "g" && wanted !== null && !isPicking.value) {
    void viewport.value?.hand.take(wanted);
  } else if (key === "r" && store.held.value.length > 0) {
    viewport.value?.hand.release();
  }
}

function onKey(event: KeyboardEvent): void {
  if (event.defaultPrevented) {
    return;
  }
  if (isParticipant()) {
    onParticipantKey(event);
    return;
  }
  if (event.key === "Escape") {
    kClosers.find((closer) => closer.isOpen())?.close();
    return;
  }
  if (isTyping(event.target)) {
    return;
  }
  if (onPictureKey(event)) {
    event.preventDefault();
    return;
  }
  const prefix = (event.ctrlKey || event.metaKey ? "ctrl+" : "") + (event.ctrlKey && event.shiftKey ? "shift+" : "");
  const found = byKey.get(prefix + event.key.toLowerCase());
  const isPlain = prefix === "";
  const isOff = isPlain && isCharacterKey(event.key) && !view.hasSingleKeys.value;
  if (found === undefined || isOff || event.altKey || (isPlain && belongsToControl(event) && event.key !== "?")) {
    return;
  }
  event.preventDefault();
  runAction(found);
}

export function listenToKeys(): void {
  addEventListener("keydown", onKeyFirst, { capture: true });
  addEventListener("keydown", onKey);
}
