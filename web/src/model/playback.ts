/** A recording that is shown: where in it, how fast, and what the work looked like then. */

import { computed, signal } from "@preact/signals";
import type { LiveState } from "../protocol/frame_store";
import type { Placement, RecordedEvent, RecordingDetail, Scene } from "../protocol/messages";
import { FrameCursor, type RecordedFrames } from "../protocol/recorded_frames";
import { addToLog, countLimits, kRunsLength, runOf, tell } from "./event_log";
import { isSameHeld, summarize } from "./held";
import { recordedMarks, type Mark } from "./marks";
import { leadersOf, withLeader, type HeldSummary, type LimitCounts, type LogEntry, type Run, type StepCount, type Work } from "./store";
import type { Trace } from "./trace";

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4, 8] as const;
/** A page that was out of sight does not jump when it is seen again [s]; slow ones draw this seldom. */
const kLongestStepS = 1;

/** All that was fetched of a recording. */
export interface RecordedRun {
  detail: RecordingDetail;
  frames: RecordedFrames;
  /** One for each hand. */
  traces: readonly Trace[];
}

interface Then {
  placements: ReadonlyMap<number, Placement>;
  leaders: ReadonlyMap<number, number>;
  step: StepCount;
  runs: readonly Run[];
  log: readonly LogEntry[];
  limits: LimitCounts;
}

export class Playback implements Work {
  readonly scene;
  readonly isPlaying = signal(false);
  readonly speed = signal(1);
  readonly marks: readonly Mark[];
  readonly durationS: number;
  private readonly cursor: FrameCursor;
  private readonly heldNow = signal<readonly HeldSummary[]>([]);
  /** How many of the events have been by now. */
  private readonly passed = signal(0);
  private readonly events: readonly RecordedEvent[];
  private readonly then = computed(() => this.replayTo(this.passed.value));
  readonly held = this.heldNow;
  readonly placements = computed(() => this.then.value.placements);
  readonly leaders = computed(() => this.then.value.leaders);
  readonly step = computed(() => this.then.value.step);
  readonly runs = computed(() => this.then.value.runs);
  readonly log = computed(() => this.then.value.log);
  readonly limits = computed(() => this.then.value.limits);
  private atS = 0;
  private lastMs: number | null = null;

  /** @param startedMs  When it was recorded, on the clock of Date.now(). */
  constructor(
    readonly run: RecordedRun,
    scene: Scene,
    private readonly startedMs: number,
  ) {
    this.scene = signal<Scene | null>({ ...scene, epoch: run.frames.epoch, glb: run.detail.glb });
    this.events = [...run.detail.events].sort((a, b) => a.t_ns - b.t_ns);
    this.cursor = new FrameCursor(run.frames);
    this.marks = recordedMarks(this.events, run.traces, this.nameOf);
    this.durationS = Math.max(run.detail.duration_s, run.frames.timesS.at(-1) ?? 0);
    this.seek(0);
  }

  get store() {
    return this.cursor.store;
  }

  /** From the beginning of the recording [s]. */
  get timeS(): number {
    return this.atS;
  }

  seek(timeS: number): void {
    this.atS = Math.min(Math.max(0, timeS), this.durationS);
    this.cursor.goTo(this.run.frames.momentAt(this.atS));
    this.passed.value = this.events.filter((event) => event.t_ns / 1e9 <= this.atS).length;
  }

  /** So many frames on, or back. */
  stepFrames(count: number): void {
    const { timesS } = this.run.frames;
    const to = Math.min(Math.max(0, this.cursor.moment + count), timesS.length - 1);
    this.isPlaying.value = false;
    this.seek(timesS[to] ?? 0);
  }

  /** From the beginning again where it stands at the end. */
  play(): void {
    if (this.atS >= this.durationS) {
      this.seek(0);
    }
    this.lastMs = null;
    this.isPlaying.value = true;
  }

  pause(): void {
    this.isPlaying.value = false;
  }

  /** Goes on by the time that has gone by. */
  tick(nowMs: number): void {
    if (!this.isPlaying.peek()) {
      return;
    }
    const seconds = this.lastMs === null ? 0 : Math.min(kLongestStepS, (nowMs - this.lastMs) / 1e3);
    this.lastMs = nowMs;
    this.seek(this.atS + seconds * this.speed.peek());
    if (this.atS >= this.durationS) {
      this.isPlaying.value = false;
    }
  }

  noteHands(live: LiveState): void {
    const next = summarize(live.hands);
    if (!isSameHeld(next, this.heldNow.peek())) {
      this.heldNow.value = next;
    }
  }

  private readonly nameOf = (occurrence: number): string =>
    this.scene.peek()?.occurrences.find((o) => o.id === occurrence)?.name ?? `${occurrence}`;

  /** The work after so many events. */
  private replayTo(passed: number): Then {
    const scene = this.scene.value!;
    const placements = new Map(scene.occurrences.map((o) => [o.id, o.placement]));
    let leaders = leadersOf(scene);
    let step: StepCount = { index: scene.next_step, total: scene.steps.length };
    const runs: Run[] = [];
    let log: readonly LogEntry[] = [];
    let limits: LimitCounts = new Map();
    for (const event of this.events.slice(0, passed)) {
      if (event.event === "placement" && event.occurrence !== undefined && event.placement !== undefined) {
        placements.set(event.occurrence, event.placement);
        leaders = withLeader(leaders, event.occurrence, event.leader);
      } else if (event.event === "step" && event.index !== undefined) {
        step = { index: event.index, total: event.total ?? step.total };
      }
      const run = runOf(event, this.nameOf);
      const told = tell(event, this.nameOf);
      if (run !== null) {
        runs.unshift(run);
      }
      limits = countLimits(limits, event);
      if (told !== null) {
        log = addToLog(log, { at: new Date(this.startedMs + event.t_ns / 1e6), timeS: event.t_ns / 1e9, ...told });
      }
    }
    return { placements, leaders, step, runs: runs.slice(0, kRunsLength), log, limits };
  }
}
