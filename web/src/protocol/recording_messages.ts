/** JSON of hands, devices and recordings: docs/protocol.md. */

import type { Placement, RunMetrics } from "./messages";

export interface DeviceInHand {
  /** "pointer" is the mouse, a finger or a controller of this page. */
  address: string;
  name: string;
  model: string;
  serial?: string;
  is_emulated: boolean;
  has_force: boolean;
  has_torque: boolean;
  /** Null while nothing is open. */
  max_force_n: number | null;
  scale: number | null;
  notes: string[];
}

export interface HandSetup {
  hand: number;
  device: DeviceInHand;
  condition: string;
}

export interface FoundDevice {
  address: string;
  driver: string;
  name: string;
  detail: string;
  is_emulated: boolean;
  is_ready: boolean;
}

export interface DeviceList {
  devices: FoundDevice[];
  is_searching: boolean;
}

/** What the hand is given by the last tick, and what it gave and took since the run began. */
export interface HandStatus {
  hand: number;
  force_n: number;
  torque_nm: number;
  energy_j: number;
}

/** Counts of the last second; `edges_us` are the upper ends of the bins, what is above them is in one more. */
export interface Histograms {
  edges_us: number[];
  compute: number[];
  wake_up: number[];
}

export interface RecordingNow {
  on: boolean;
  id: string;
  name: string;
  t_s: number;
}

export interface RecordingEntry {
  id: string;
  name: string;
  product: string;
  started_unix_ms: number;
  duration_s: number;
  is_complete: boolean;
  bytes: number;
}

export interface PartResult {
  occurrence: number;
  path: string;
  is_seated: boolean;
  time_s: number;
  path_m: number;
  peak_true_n: number;
  peak_felt_n: number;
  collisions: number;
  insertion_mm: number;
}

/** An event as it was broadcast, and when. */
export interface RecordedEvent {
  event: string;
  t_ns: number;
  hand?: number;
  occurrence?: number;
  placement?: Placement;
  state?: string | number;
  was_seated?: boolean;
  metrics?: RunMetrics;
  index?: number;
  total?: number;
  reasons?: string[];
  gate_actions?: number;
  off?: boolean;
  on?: boolean;
}

export interface RecordingDetail {
  id: string;
  name: string;
  product: string;
  duration_s: number;
  /** Addresses of what belongs to it. */
  scene: string;
  glb: string;
  frames: string;
  events: RecordedEvent[];
  results: PartResult[];
}
