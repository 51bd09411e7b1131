/** Keys: the shortcuts of the actions, and those that move what is in the hand. */

import { actions, forcesOff, runAction } from "./actions";
import { clearPicks, select } from "../model/view_state";
import { store, studio, ui, view, viewport } from "./app_state";

const kNudgePx = 6;

const byKey = new Map(actions.flatMap((a) => (a.keys ?? []).map((key) => [key, a] as const)));

function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName));
}

/** Keys that a focused control needs for itself. */
function belongsToControl(event: KeyboardEvent): boolean {
  const target = event.target;
  if (!(target instanceof HTMLElement)) {
    return false;
  }
  const moves = /^(Arrow|Page|Home|End|Enter$| $)/.test(event.key);
  const owner = moves ? "[role=tree],[role=menu],[role=tablist],button" : "[role=menu],[role=listbox]";
  return target.closest(owner) !== null;
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

/** Away with what is open or half done; where anything moves by itself or is held, the force as well. */
function escape(): void {
  const isOpen = ui.overlay.value !== null;
  ui.overlay.value = null;
  if (store.live.held.value.length > 0 || store.demo.value) {
    forcesOff();
  } else if (!isOpen) {
    if (view.picked.value.length > 0 || view.tool.value !== "hand") {
      clearPicks(view);
      view.tool.value = "hand";
    } else if (view.selected.value.length > 0) {
      select(view, [], false);
    } else {
      forcesOff();
    }
  }
}

/** In a study there is the hand, and the way out; no view, tool or help that others did not have. */
function onParticipantKey(event: KeyboardEvent): void {
  const { isPicking, isTask, state } = studio.study;
  if (event.key === "Escape") {
    forcesOff();
    return;
  }
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
  } else if (moveHeld(event)) {
    event.preventDefault();
  }
}

function onKey(event: KeyboardEvent): void {
  if (studio.study.isParticipantView.value) {
    onParticipantKey(event);
    return;
  }
  if (event.key === "Escape") {
    escape();
    return;
  }
  if (isTyping(event.target) || event.defaultPrevented) {
    return;
  }
  if (!belongsToControl(event) && ui.overlay.value === null && moveHeld(event)) {
    event.preventDefault();
    return;
  }
  const prefix = (event.ctrlKey || event.metaKey ? "ctrl+" : "") + (event.ctrlKey && event.shiftKey ? "shift+" : "");
  const found = byKey.get(prefix + event.key.toLowerCase());
  const isPlain = prefix === "";
  if (found === undefined || event.altKey || (isPlain && belongsToControl(event) && event.key !== "?")) {
    return;
  }
  event.preventDefault();
  runAction(found);
}

export function listenToKeys(): void {
  addEventListener("keydown", onKey);
}
