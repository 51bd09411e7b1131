/** A recording of a toy: one body that slides in, one that is moved now and then, made by the frame code itself. */

import {
  BodyPoseSize,
  ContactPointSize,
  FrameKind,
  HandStateSize,
  HeaderSize,
  kNone,
  writeBodyPose,
  writeContactPoint,
  writeHandState,
  type HandState,
} from "../src/protocol/frames";
import { joinBytes, makeFrame } from "../src/protocol/decoder";
import type { RecordedEvent, RecordingDetail, Scene } from "../src/protocol/messages";
import { makePart } from "./toy_part";

export const kPeriodNs = 16_666_667;

const kHand: HandState = {
  hand: 0,
  state: 1,
  occurrence: 1,
  mate: kNone,
  gate_actions: 0,
  contact_count: 0,
  p_WH_m: [0, 0, 0],
  q_WH: [1, 0, 0, 0],
  p_WT_m: [0, 0, 0],
  q_WT: [1, 0, 0, 0],
  p_WD_m: [0, 0, 0],
  q_WD: [1, 0, 0, 0],
  f_felt_W_n: [0, 0, 0],
  t_felt_W_nm: [0, 0, 0],
  f_true_W_n: [0, 0, 0],
  t_true_W_nm: [0, 0, 0],
  peak_felt_n: 0,
  axial_true_n: 0,
  axial_felt_n: 0,
  depth_m: 0,
  depth_goal_m: 0.05,
  tilt_rad: 0,
  offset_m: 0,
  penetration_m: 0,
  p_WAxis_m: [0, 0, 0],
  axis_W: [0, 0, 0],
};

function pack<T>(
  kind: number,
  t_ns: bigint,
  items: readonly T[],
  size: number,
  write: (view: DataView, at: number, item: T) => void,
): Uint8Array {
  const view = makeFrame(kind, 3, items.length, size, t_ns);
  items.forEach((item, k) => write(view, HeaderSize + k * size, item));
  return new Uint8Array(view.buffer);
}

/** Where body `occurrence` is at a moment: 0 never moves, 1 always, 2 in every seventh. */
export function positionAt(occurrence: number, moment: number): number {
  const last = occurrence === 0 ? 0 : occurrence === 1 ? moment : moment - (moment % 7);
  return 0.001 * last + occurrence;
}

/** The hand's state at a moment; `more` changes it. */
function handAt(moment: number, more: (moment: number) => Partial<HandState>): HandState {
  return { ...kHand, depth_m: 1e-4 * moment, f_felt_W_n: [0, 0, 0.01 * moment], ...more(moment) };
}

export function toyFrames(moments: number, more: (moment: number) => Partial<HandState> = () => ({})): ArrayBuffer {
  const pieces: Uint8Array[] = [];
  for (let moment = 0; moment < moments; moment++) {
    const t_ns = BigInt(moment * kPeriodNs);
    const moved = [0, 1, 2].filter((id) => moment === 0 || positionAt(id, moment) !== positionAt(id, moment - 1));
    const poses = moved.map((id) => ({ occurrence: id, p_WB_m: [positionAt(id, moment), 0, 0], q_WB: [1, 0, 0, 0] }));
    const hand = handAt(moment, more);
    pieces.push(pack(FrameKind.Poses, t_ns, poses, BodyPoseSize, writeBodyPose));
    pieces.push(pack(FrameKind.Hands, t_ns, [hand], HandStateSize, writeHandState));
    if (hand.contact_count > 0) {
      const contact = { hand: 0, occurrence: 0, p_WC_m: [moment, 0, 0], f_C_W_n: [0, 0, 1] };
      pieces.push(pack(FrameKind.Contacts, t_ns, [contact], ContactPointSize, writeContactPoint));
    }
  }
  return joinBytes(pieces);
}

/** One moment of several hands. */
export function handsFrame(hands: readonly number[]): ArrayBuffer {
  const states = hands.map((hand) => ({ ...kHand, hand }));
  return joinBytes([pack(FrameKind.Hands, BigInt(kPeriodNs), states, HandStateSize, writeHandState)]);
}

export function toyDetail(events: RecordedEvent[], durationS: number): RecordingDetail {
  return {
    id: "r1",
    name: "First",
    product: "toy",
    started_unix_ms: 1_700_000_000_000,
    duration_s: durationS,
    is_complete: true,
    is_shared: false,
    bytes: 0,
    scene: "/api/recording/r1/scene",
    glb: "/api/recording/r1/model.glb",
    frames: "/api/recording/r1/frames",
    events,
    results: [],
  };
}

export const toyScene: Scene = {
  epoch: 3,
  name: "toy",
  source: "toy.step",
  glb: "/api/model/0.glb",
  triangles: 10,
  table_z_m: 0,
  centre_m: [0, 0, 0],
  radius_m: 0.1,
  seed: "1",
  next_step: 1,
  pending: 0,
  subassemblies: [{ id: 0, parent: null, name: "toy", subassemblies: [], occurrences: [0, 1, 2] }],
  occurrences: [0, 1, 2].map((id) =>
    makePart(id, `part ${id}`, id, {
      start: { p: [id, 0, 0], q: [1, 0, 0, 0] },
      placement: id === 0 ? "placed" : "loose",
      is_base: id === 0,
    }),
  ),
  mates: [],
  left_out: [],
  steps: [0, 1, 2].map((occurrence) => ({
    kind: occurrence === 0 ? "base" : "insert",
    occurrence,
    members: [],
    way_in: [0, 0, -1],
    distance_m: 0.05,
  })),
  diagnostics: [],
};
