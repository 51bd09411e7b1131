/** What the system thinks the hand is doing, as a key of the catalogue with its values. */

import type { HandState } from "../protocol/frames";
import { kHoldStates, type HoldState, type Scene } from "../protocol/messages";

export type HintKey =
  | "hint.viewer"
  | "hint.empty"
  | "hint.emptyExpected"
  | "hint.done"
  | "hint.free"
  | "hint.near"
  | "hint.nearPlace"
  | "hint.capturedPlace"
  | "hint.matingPlace"
  | "hint.captured"
  | "hint.mating"
  | "hint.seated";

export interface Hint {
  key: HintKey;
  state: HoldState;
  params: { part: string; into: string; expected: string };
}

/** The name of a state as frames and events have it. */
export function holdStateOf(state: number): HoldState {
  return kHoldStates[state] ?? "empty";
}

function nameOf(scene: Scene, id: number): string {
  return scene.occurrences.find((o) => o.id === id)?.name ?? "";
}

export interface HintInput {
  scene: Scene;
  held: { occurrence: number; state: HoldState; mate: number | null } | null;
  expected: number | null;
  /** Every part is in its place. */
  isDone: boolean;
  canSteer: boolean;
}

export function makeHint({ scene, held, expected, isDone, canSteer }: HintInput): Hint {
  const expectedName = expected === null ? "" : nameOf(scene, expected);
  if (held === null || held.state === "empty") {
    const key = !canSteer ? "hint.viewer" : expected !== null ? "hint.emptyExpected" : "hint.empty";
    return {
      key: isDone ? "hint.done" : key,
      state: "empty",
      params: { part: "", into: "", expected: expectedName },
    };
  }
  const { state } = held;
  const mate = held.mate === null ? undefined : scene.mates.find((m) => m.id === held.mate);
  const other = mate === undefined ? null : mate.a === held.occurrence ? mate.b : mate.a;
  return {
    // Near a mate it may not be said which.
    key: other === null && (state === "near" || state === "captured" || state === "mating") ? `hint.${state}Place` : `hint.${state}`,
    state: held.state,
    params: {
      part: nameOf(scene, held.occurrence),
      into: other === null ? "" : nameOf(scene, other),
      expected: expectedName,
    },
  };
}

export interface LiveNumbers {
  depthMm: number;
  depthGoalMm: number;
  /** 0 to 1. */
  depthShare: number;
  tiltDeg: number;
  offsetMm: number;
  feltN: number;
  trueN: number;
}

export function liveNumbers(hand: HandState): LiveNumbers {
  const goal = hand.depth_goal_m;
  return {
    depthMm: 1e3 * hand.depth_m,
    depthGoalMm: 1e3 * goal,
    depthShare: goal > 0 ? Math.min(1, Math.max(0, hand.depth_m / goal)) : 0,
    tiltDeg: (hand.tilt_rad * 180) / Math.PI,
    offsetMm: 1e3 * hand.offset_m,
    feltN: Math.hypot(...hand.f_felt_W_n),
    trueN: Math.hypot(...hand.f_true_W_n),
  };
}
