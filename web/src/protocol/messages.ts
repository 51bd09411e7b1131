/** JSON of the studio: docs/protocol.md. */

import type {
  DeviceList,
  HandSetup,
  HandStatus,
  Histograms,
  RecordingNow,
} from "./recording_messages";
import type { StudyCommand, StudyReply, StudyState } from "./study_messages";

export type Vec3 = readonly [number, number, number];
/** w, x, y, z. */
export type Quat = readonly [number, number, number, number];

export interface Pose {
  readonly p: Vec3;
  readonly q: Quat;
}

export interface ServerError {
  code: string;
  message: string;
  where: string;
  remedy: string;
}

export type Placement = "loose" | "held" | "placed" | "parked";
export type Role = "operator" | "viewer" | "participant";
export type HoldState = "empty" | "free" | "near" | "captured" | "mating" | "seated";

export const kHoldStates: readonly HoldState[] = ["empty", "free", "near", "captured", "mating", "seated"];

export interface Subassembly {
  id: number;
  parent: number | null;
  name: string;
  subassemblies: number[];
  occurrences: number[];
}

export interface Occurrence {
  id: number;
  name: string;
  path: string;
  parent: number | null;
  part: number;
  color: string;
  placement: Placement;
  start: Pose;
  goal: Pose;
  mass_kg: number;
  material: string;
  p_BoBcm_m: Vec3;
  is_base: boolean;
}

export interface Fit {
  code: string;
  kind: "clearance" | "transition" | "interference" | "thread";
  diameter_mm: number;
  clearance_min_um: number;
  clearance_max_um: number;
  clearance_actual_um: number;
  is_proposed: boolean;
  reason: string;
}

export interface Mate {
  id: number;
  key: string;
  kind: "axis_hole" | "face_face" | "cone_seat" | "sphere_seat";
  a: number;
  b: number;
  faces_a: number[];
  faces_b: number[];
  origin: "inferred" | "user";
  p_m: Vec3;
  axis: Vec3;
  confidence: number;
  evidence: string;
  fit: Fit | null;
}

export interface Step {
  kind: "base" | "insert" | "park";
  occurrence: number;
  members: number[];
  way_in: Vec3;
  distance_m: number;
}

export interface Diagnostic {
  severity: string;
  code: string;
  entity: string;
  message: string;
  remedy: string;
}

export interface Scene {
  epoch: number;
  name: string;
  source: string;
  glb: string;
  triangles: number;
  table_z_m: number;
  centre_m: Vec3;
  radius_m: number;
  seed: string;
  /** Index of the step whose turn it is. */
  next_step: number;
  subassemblies: Subassembly[];
  occurrences: Occurrence[];
  mates: Mate[];
  steps: Step[];
  diagnostics: Diagnostic[];
}

export interface FaceOf {
  occurrence: number;
  face: number;
}

export interface Measurement {
  kind: string;
  distance_mm?: number | null;
  angle_deg?: number | null;
  radius_mm?: number | null;
  area_mm2?: number | null;
  text: string;
  p_m: Vec3[];
}

/** The way of a part: its centre of mass, and the part itself. */
export interface PathPoints {
  points_m: Vec3[];
  poses: Pose[];
}

/** The room that a part takes along its way. */
export interface PathSwept {
  glb: string;
  volume_mm3: number;
  error_mm: number;
}

/** What a client asks for. None has an "id" of its own: by that of the message the answer is known. */
export type Command =
  | { command: "open"; example?: string; upload?: string }
  | { command: "cancel" }
  | { command: "take"; hand: number; occurrence: number }
  | { command: "release"; hand: number }
  | { command: "forces"; off: boolean }
  | { command: "demo"; on: boolean }
  | { command: "next" }
  | { command: "undo" }
  | { command: "redo" }
  | { command: "reset" }
  | { command: "assign_fit"; mate: number; fit: string }
  | { command: "add_mate"; a: FaceOf; b: FaceOf; fit?: string }
  | { command: "remove_mate"; mate: number }
  | { command: "measure"; a: FaceOf; b?: FaceOf }
  | { command: "path"; occurrence: number; as: "points" | "swept"; resolution_mm?: number }
  | { command: "lease"; action: "request" | "release" | "give"; hand?: number; to?: string }
  | { command: "status" }
  | { command: "hands"; count: number }
  | { command: "devices" }
  | { command: "use"; hand: number; device: string; scale?: number }
  | { command: "record"; on: boolean; name?: string }
  | { command: "rename_recording"; recording: string; name: string }
  | { command: "delete_recording"; recording: string }
  | StudyCommand;

type Nothing = Record<string, never>;
export interface CommandResults {
  open: Nothing;
  cancel: Nothing;
  take: { hand: Pose };
  release: Nothing;
  forces: Nothing;
  demo: Nothing;
  next: Nothing;
  undo: Nothing;
  redo: Nothing;
  reset: Nothing;
  assign_fit: Nothing;
  add_mate: Nothing;
  remove_mate: Nothing;
  measure: Measurement;
  path: PathPoints | PathSwept;
  lease: { waits_for?: string };
  status: Nothing;
  hands: Nothing;
  devices: DeviceList;
  use: Nothing;
  record: Nothing;
  rename_recording: Nothing;
  delete_recording: Nothing;
  study: StudyReply;
}

export interface Example {
  id: string;
  name: string;
  about: string;
}

export interface RunMetrics {
  time_s: number;
  path_mm: number;
  peak_true_n: number;
  peak_felt_n: number;
  fit_true_n: number;
  depth_um: number;
  insertion_mm: number;
}

export interface Client {
  id: string;
  role: Role;
  has_lease: boolean;
  /** Which hands it leads. */
  hands?: number[];
}

export interface ServerStatus {
  tick_hz: number;
  compute_p99_us: number;
  wake_up_p99_us: number;
  scheduling: string;
  physics_hz: number;
  late_ticks: number;
  lost_events: number;
  clients: number;
  effort_level: number;
  histograms?: Histograms;
  hands?: HandStatus[];
}

export type ServerEvent =
  | {
      event: "hello";
      version: number;
      role: Role;
      client: string;
      has_lease: boolean;
      examples: Example[];
      forces_off: boolean;
      has_scene: boolean;
      hands?: HandSetup[];
      recording?: RecordingNow | null;
      demo: boolean;
    }
  | { event: "progress"; stage: string; fraction: number; file: string }
  | { event: "failed"; file?: string; error: ServerError }
  /** `why` it is another one than before; null: it was opened. */
  | { event: "scene"; epoch: number; why?: string | null }
  /** The work of the program's start before goes on, or cannot. */
  | { event: "resumed"; is_resumed: boolean; seated: number; edits: number }
  | { event: "placement"; occurrence: number; placement: Placement }
  | { event: "taken"; hand: number; occurrence: number; state: HoldState | number }
  | { event: "state"; hand: number; occurrence?: number; state: HoldState | number }
  | {
      event: "dropped";
      hand: number;
      occurrence: number;
      state: HoldState | number;
      was_seated: boolean;
      /** How far it is from its place; 0 in it. */
      to_place_mm?: number;
      /** Not for participants of a study. */
      metrics?: RunMetrics;
    }
  | { event: "step"; index: number; total: number }
  | { event: "safety"; reasons: string[]; gate_actions: number }
  | { event: "forces"; off: boolean; by: string | null }
  | { event: "roles"; clients: Client[] }
  | { event: "lease_asked"; by: string; hands: number[] }
  | { event: "history"; undo: string | null; redo: string | null }
  | { event: "demo"; on: boolean }
  | { event: "hands"; hands: HandSetup[] }
  | { event: "device"; hand: number; condition: string; text: string }
  | ({ event: "devices" } & DeviceList)
  | ({ event: "recording" } & RecordingNow)
  | { event: "recordings" }
  | ({ event: "study" } & StudyState)
  | ({ event: "status" } & ServerStatus);
