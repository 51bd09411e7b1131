/** A study as this page knows it: what the server told last, and what one may do about it. */

import { computed, signal } from "@preact/signals";
import type {
  AnswerValue,
  ExperimenterState,
  FaceOf,
  StudyCommand,
  StudyQuestion,
  StudyState,
} from "../protocol/messages";
import type { Commander } from "./commander";
import type { Store } from "./store";

type Action = StudyCommand extends infer Each ? (Each extends StudyCommand ? Omit<Each, "command"> : never) : never;

/** Phases in which the product is in sight, and the hand may work. */
function isTask(state: StudyState | null): boolean {
  return state !== null && (state.phase === "running" || (state.phase === "training" && state.is_running));
}

export class StudyModel {
  /** What was sent and is not answered yet: a second press of the same counts for nothing. */
  private readonly pending = signal<ReadonlySet<Action["action"]>>(new Set());
  readonly isBusy = computed(() => this.pending.value.size > 0);
  /** Constraints that are still to be picked; null: none was picked yet. */
  readonly leftToPick = signal<number | null>(null);
  readonly state = computed(() => this.store.study.value);
  readonly phase = computed(() => this.state.value?.phase ?? "waiting");
  readonly isTask = computed(() => isTask(this.state.value));
  readonly isPicking = computed(() => this.isTask.value && this.state.value?.method === "picking");
  /** What the experimenter is told; null on all other pages. */
  readonly experimenter = computed<ExperimenterState | null>(() => {
    const state = this.state.value;
    return state?.view === "experimenter" ? state : null;
  });
  /** This page shows what the participant sees. */
  readonly isParticipantView = computed(
    () => this.store.role.value === "participant" || this.state.value?.view === "participant",
  );
  /** This page is the participant's, and not that of somebody who looks on. */
  readonly mayAct = computed(() => this.store.role.value === "participant" && this.store.link.value === "open");
  /** Share of the trials that are over; null where it is not told. */
  readonly progress = computed(() => {
    const state = this.state.value;
    if (state === null || state.trial === null || state.trials === null || state.trials <= 0) {
      return null;
    }
    return state.phase === "done" ? 1 : Math.min(1, Math.max(0, (state.trial - 1) / state.trials));
  });
  /** The trial at hand has been laid out on this page as well, and its clock runs; where the time is hidden, that is not
   told. What is done before would be lost: the view begins anew with the trial's own scene. */
  readonly isLive = computed(() => {
    const state = this.state.value;
    if (state === null || !isTask(state)) {
      return false;
    }
    const hasNewScene = (this.store.scene.value?.epoch ?? null) !== this.epochBefore.value;
    return hasNewScene && (state.limit_s === null || state.elapsed_s !== null);
  });
  /** That the participant chose before the consent; null: none yet. */
  readonly chosenLanguage = signal<string | null>(null);
  /** Of all that the participant reads; null while no study is known. */
  readonly language = computed(() => {
    const state = this.state.value;
    if (state === null || (state.phase !== "consent" && state.phase !== "waiting")) {
      return state?.language ?? null;
    }
    const liked = [this.chosenLanguage.value, ...this.spoken.map((tag) => tag.slice(0, 2).toLowerCase())];
    return liked.find((code) => code !== null && state.languages.includes(code)) ?? state.language;
  });
  /** Of the scene before the trial. */
  private readonly epochBefore = signal<number | null>(null);
  private toldMs = 0;

  /** @param spoken  Tags of the languages that the browser's user prefers. */
  constructor(
    private readonly store: Store,
    private readonly commander: Commander,
    private readonly spoken: readonly string[] = [],
  ) {}

  /** @param nowMs  On the clock of performance.now(). */
  take(state: StudyState, nowMs = performance.now()): void {
    const before = this.store.study.peek();
    if (before === null || !isTask(before) || !isTask(state) || before.trial !== state.trial) {
      this.leftToPick.value = null;
    }
    if (!isTask(state)) {
      this.epochBefore.value = this.store.scene.peek()?.epoch ?? null;
    }
    this.toldMs = nowMs;
    this.store.study.value = state;
  }

  /** Of the trial or training that runs [s]; null where the participant is not told. */
  elapsedS(nowMs = performance.now()): number | null {
    const state = this.state.peek();
    if (state === null || state.elapsed_s === null || !isTask(state)) {
      return null;
    }
    // The server says it once a second; what has passed since is added, but no more than that.
    const since = this.store.link.peek() === "open" ? Math.min(1, Math.max(0, (nowMs - this.toldMs) / 1000)) : 0;
    return Math.min(state.limit_s ?? Infinity, state.elapsed_s + since);
  }

  refresh(): Promise<boolean> {
    return this.act({ action: "state" });
  }

  begin(): Promise<boolean> {
    return this.act({ action: "begin" });
  }

  consent(agreed: boolean): Promise<boolean> {
    return this.act({ action: "consent", agreed, language: this.language.peek() ?? "en" });
  }

  ready(): Promise<boolean> {
    return this.act({ action: "ready" });
  }

  next(): Promise<boolean> {
    return this.act({ action: "next" });
  }

  answer(question: string, value: AnswerValue): Promise<boolean> {
    return this.act({ action: "answer", question, value });
  }

  pick(a: FaceOf, b: FaceOf): Promise<boolean> {
    return this.act({ action: "pick", a, b });
  }

  note(text: string): Promise<boolean> {
    return this.act({ action: "note", text });
  }

  abort(reason: string): Promise<boolean> {
    return this.act({ action: "abort", reason });
  }

  resume(): Promise<boolean> {
    return this.act({ action: "resume" });
  }

  /** @return Whether it was done. */
  private async act(action: Action): Promise<boolean> {
    const { pending } = this;
    if (pending.peek().has(action.action)) {
      return false;
    }
    pending.value = new Set(pending.peek()).add(action.action);
    try {
      const reply = await this.commander.command<"study">({ command: "study", ...action } as StudyCommand);
      if (reply === null) {
        return false;
      }
      this.take(reply.state);
      this.leftToPick.value = reply.left ?? this.leftToPick.value;
      return action.action !== "pick" || reply.is_set === true;
    } finally {
      pending.value = new Set([...pending.peek()].filter((each) => each !== action.action));
    }
  }
}

/** The numbers of a scale, from its low end to its high one. */
export function stepsOf(question: StudyQuestion): readonly number[] {
  const low = question.low ?? 1;
  return Array.from({ length: Math.max(0, (question.high ?? 10) - low) + 1 }, (_, k) => low + k);
}

/** The question of blind identification: it has to be answered. */
export const kIdentifyQuestion = "identify";

export type AnswerFault = "missing" | "tooLong" | "unknown";

/** What is wrong with an answer before it is sent; null: nothing. */
export function faultOf(question: StudyQuestion, value: AnswerValue): AnswerFault | null {
  if (value === null || value === "") {
    return "missing";
  }
  switch (question.kind) {
    case "scale":
      return stepsOf(question).includes(Number(value)) ? null : "unknown";
    case "choice":
      return (question.choices ?? []).some((choice) => choice.id === value) ? null : "unknown";
    case "text":
      return [...String(value)].length > (question.longest ?? Infinity) ? "tooLong" : null;
  }
}
