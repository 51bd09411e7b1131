/** What the server has said: a mirror in signals. Only `Studio` writes to it. */

import { computed, signal } from "@preact/signals";
import type {
  Client,
  Example,
  HoldState,
  Occurrence,
  Placement,
  Role,
  RunMetrics,
  Scene,
  ServerError,
  ServerStatus,
  Step,
} from "../protocol/messages";

export type LinkState = "starting" | "open" | "lost" | "denied";

export interface HeldSummary {
  hand: number;
  occurrence: number;
  state: HoldState;
  mate: number | null;
}

export interface Run {
  occurrence: number;
  name: string;
  wasSeated: boolean;
  metrics: RunMetrics;
}

export type LogKind = "taken" | "dropped" | "state" | "safety" | "limit" | "forces" | "step" | "failed" | "opened" | "demo";

export interface LogEntry {
  at: Date;
  kind: LogKind;
  params: Record<string, string | number>;
}

export interface Loading {
  stage: string;
  fraction: number;
  file: string;
}

export interface History {
  undo: string | null;
  redo: string | null;
}

export function makeStore() {
  const scene = signal<Scene | null>(null);
  const placements = signal<ReadonlyMap<number, Placement>>(new Map());
  const held = signal<readonly HeldSummary[]>([]);
  const step = signal<{ index: number; total: number } | null>(null);
  return {
    link: signal<LinkState>("starting"),
    role: signal<Role>("viewer"),
    client: signal(0),
    hasLease: signal(false),
    clients: signal<readonly Client[]>([]),
    examples: signal<readonly Example[]>([]),
    scene,
    placements,
    /** What each hand holds; changes with its state, not with its pose. */
    held,
    step,
    loading: signal<Loading | null>(null),
    /** The share of a file that has gone to the server, while it goes. */
    upload: signal<{ file: string; fraction: number } | null>(null),
    failure: signal<ServerError | null>(null),
    forcesOff: signal(false),
    safety: signal<{ reasons: string[] } | null>(null),
    demo: signal(false),
    history: signal<History>({ undo: null, redo: null }),
    status: signal<ServerStatus | null>(null),
    runs: signal<readonly Run[]>([]),
    log: signal<readonly LogEntry[]>([]),
    /** Refused commands and the like: told once, for some seconds. */
    notice: signal<{ text: string; isError: boolean; id: number } | null>(null),

    occurrences: computed<ReadonlyMap<number, Occurrence>>(
      () => new Map((scene.value?.occurrences ?? []).map((o) => [o.id, o])),
    ),
    expected: computed<Step | null>(() => {
      const current = step.value;
      return current === null ? null : (scene.value?.steps[current.index] ?? null);
    }),
    /** By occurrence. */
    heldBy: computed<ReadonlyMap<number, HeldSummary>>(() => new Map(held.value.map((h) => [h.occurrence, h]))),
  };
}

export type Store = ReturnType<typeof makeStore>;
