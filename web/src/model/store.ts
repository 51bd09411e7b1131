/** What the server has said: a mirror in signals. Only `Studio` writes to it. */

import { computed, signal, type ReadonlySignal } from "@preact/signals";
import type {
  Client,
  DeviceList,
  Example,
  HandSetup,
  HoldState,
  Note,
  Occurrence,
  Placement,
  RecordingEntry,
  Role,
  RunMetrics,
  Scene,
  ServerError,
  ServerStatus,
  Step,
  StudyState,
  ServerEvent,
} from "../protocol/messages";

export type LinkState = "starting" | "open" | "lost" | "denied";

export type Looking = Extract<ServerEvent, { event: "looking" }>;

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
  /** As far as the frames show them. */
  collisions: number;
}

export type LogKind =
  | "taken"
  | "dropped"
  | "state"
  | "safety"
  | "forces"
  | "step"
  | "failed"
  | "stopped"
  | "opened"
  | "changed"
  | "resumed"
  | "demo"
  | "recording";

export interface LogEntry {
  at: Date;
  /** Of a recording: from its beginning. */
  timeS?: number;
  kind: LogKind;
  params: Record<string, string | number>;
  /** How often an alarm has come again. */
  count?: number;
}

/** How often the force was limited, by reason: in the course of the work that comes by the dozen. */
export type LimitCounts = ReadonlyMap<string, number>;

export interface Loading {
  stage: string;
  fraction: number;
  file: string;
}

export interface StepCount {
  index: number;
  total: number;
}

export interface History {
  undo: string | null;
  redo: string | null;
}

/** What is shown of the work: that of now, or of a recording. */
export interface Work {
  readonly scene: ReadonlySignal<Scene | null>;
  readonly placements: ReadonlySignal<ReadonlyMap<number, Placement>>;
  /** By part that was put together with others on the table: the part that leads them. */
  readonly leaders: ReadonlySignal<ReadonlyMap<number, number>>;
  /** What each hand holds; changes with its state, not with its pose. */
  readonly held: ReadonlySignal<readonly HeldSummary[]>;
  readonly step: ReadonlySignal<StepCount | null>;
  readonly runs: ReadonlySignal<readonly Run[]>;
  readonly log: ReadonlySignal<readonly LogEntry[]>;
  readonly limits: ReadonlySignal<LimitCounts>;
}

/** What the server records now. */
export interface Recording {
  id: string;
  name: string;
  /** On the clock of performance.now(). */
  sinceMs: number;
}

/** What is put together with a part on the table, and the part itself. */
export function togetherWith(leaders: ReadonlyMap<number, number>, id: number): number[] {
  const leader = leaders.get(id);
  return leader === undefined ? [id] : [...leaders].filter(([, of]) => of === leader).map(([member]) => member);
}

/** Without the part where it is by itself. */
export function withLeader(leaders: ReadonlyMap<number, number>, id: number, leader: number | undefined): ReadonlyMap<number, number> {
  const next = new Map(leaders);
  if (leader === undefined) {
    next.delete(id);
  } else {
    next.set(id, leader);
  }
  return next;
}

/** As a scene says it. */
export function leadersOf(scene: Scene): ReadonlyMap<number, number> {
  return new Map(scene.occurrences.flatMap((o) => (o.leader === undefined ? [] : [[o.id, o.leader] as const])));
}

function makeLiveWork() {
  return {
    scene: signal<Scene | null>(null),
    placements: signal<ReadonlyMap<number, Placement>>(new Map()),
    leaders: signal<ReadonlyMap<number, number>>(new Map()),
    held: signal<readonly HeldSummary[]>([]),
    step: signal<StepCount | null>(null),
    runs: signal<readonly Run[]>([]),
    log: signal<readonly LogEntry[]>([]),
    limits: signal<LimitCounts>(new Map()),
  } satisfies Work;
}

export function makeStore() {
  const live = makeLiveWork();
  const replay = signal<Work | null>(null);
  const shown = <K extends keyof Work>(name: K) =>
    computed(() => (replay.value ?? live)[name].value as Work[K]["value"]);
  const scene = shown("scene");
  const placements = shown("placements");
  const leaders = shown("leaders");
  const held = shown("held");
  const step = shown("step");
  const link = signal<LinkState>("starting");
  const hasLease = signal(false);
  /** Whether this browser came first by the first link. */
  const isOwner = signal(false);
  const client = signal("");
  const clients = signal<readonly Client[]>([]);
  const study = signal<StudyState | null>(null);
  /** Whoever watches over a study does not do its work. */
  const isWatchingOver = computed(() => study.value?.view === "experimenter");
  /** What has come of the meshes of a product, as a share of them; null: none are on their way. */
  const meshShare = signal<number | null>(null);
  return {
    link,
    meshShare,
    /** @param size  Of the meshes; not known of those of older recordings. */
    followMeshes: async <T>(size: number | undefined, load: (tell: (bytes: number) => void) => Promise<T>): Promise<T> => {
      try {
        return await load((bytes) => (meshShare.value = size === undefined ? null : Math.min(1, bytes / size)));
      } finally {
        meshShare.value = null;
      }
    },
    /** Why this page is not let in, as far as the server has said it. */
    denial: signal<ServerError | null>(null),
    /** The server has said nothing for a second, though it should have. */
    isSilent: signal(false),
    role: signal<Role>("viewer"),
    /** The server has said which role this page has. */
    isGreeted: signal(false),
    /** While a study runs. */
    study,
    client,
    hasLease,
    isOwner,
    clients,
    /** Who asks this page for control, and of which hands. */
    leaseAsked: signal<{ by: string; hands: readonly number[] } | null>(null),
    /** Who asks for the part that is in a hand of this page, and for which hand of theirs. */
    partAsked: signal<{ by: string; hand: number; to: number; occurrence: number } | null>(null),
    /** Where others look and point to, by client. */
    looking: signal<ReadonlyMap<string, Looking>>(new Map()),
    /** The client whose view this page follows. */
    followed: signal<string | null>(null),
    notes: signal<readonly Note[]>([]),
    examples: signal<readonly Example[]>([]),
    live,
    /** The recording that is shown in place of what is live. */
    replay,
    scene,
    placements,
    leaders,
    held,
    step,
    runs: shown("runs"),
    log: shown("log"),
    limits: shown("limits"),
    /** What each hand is; none before the server has said it. */
    hands: signal<readonly HandSetup[]>([]),
    /** What is the matter with a hand's device, and what to do about it. */
    deviceTroubles: signal<ReadonlyMap<number, string>>(new Map()),
    devices: signal<DeviceList | null>(null),
    recording: signal<Recording | null>(null),
    recordings: signal<readonly RecordingEntry[] | null>(null),
    loading: signal<Loading | null>(null),
    orderProgress: signal<{ stage: string; fraction: number } | null>(null),
    /** The share of a file that has gone to the server, while it goes. */
    upload: signal<{ file: string; fraction: number } | null>(null),
    failure: signal<ServerError | null>(null),
    forcesOff: signal(false),
    safety: signal<{ reasons: readonly string[] } | null>(null),
    demo: signal(false),
    history: signal<History>({ undo: null, redo: null }),
    status: signal<ServerStatus | null>(null),
    /** Refused commands and the like: told once, for some seconds. */
    notice: signal<{ text: string; isError: boolean; id: number } | null>(null),

    occurrences: computed<ReadonlyMap<number, Occurrence>>(
      () => new Map((scene.value?.occurrences ?? []).map((o) => [o.id, o])),
    ),
    expected: computed<Step | null>(() => {
      const wanted = study.value?.occurrence ?? null;
      if (wanted !== null) {
        return scene.value?.steps.find((each) => each.occurrence === wanted) ?? null;
      }
      const current = step.value;
      return current === null ? null : (scene.value?.steps[current.index] ?? null);
    }),
    /** Every part is in its place. */
    isDone: computed(() =>
      (scene.value?.occurrences ?? []).every((o) => o.is_base || placements.value.get(o.id) === "placed"),
    ),
    /** May this page do what changes the work? */
    canSteer: computed(
      () => hasLease.value && link.value === "open" && replay.value === null && !isWatchingOver.value,
    ),
    /** The hands that this page leads. */
    ownHands: computed<readonly number[]>(() => {
      if (isWatchingOver.value) {
        return [];
      }
      const own = clients.value.find((c) => c.id === client.value);
      return own?.hands ?? (hasLease.value ? [0] : []);
    }),
    /** By occurrence, with what was put together with a held part and is in the hand as well. */
    heldBy: computed<ReadonlyMap<number, HeldSummary>>(() => {
      const isHeld = (id: number) => placements.value.get(id) === "held";
      const all = held.value.flatMap((h) => [h.occurrence, ...togetherWith(leaders.value, h.occurrence).filter(isHeld)].map((id) => [id, h] as const));
      return new Map(all);
    }),
  };
}

export type Store = ReturnType<typeof makeStore>;
