/** Studies, as the studio's server tells them: docs/protocol.md. */

import type { FaceOf, HoldState } from "./messages";

export type StudyPhase =
  | "waiting"
  | "consent"
  | "training"
  | "ready"
  | "running"
  | "question"
  | "paused"
  | "declined"
  | "done";

export interface StudyChoice {
  id: string;
  text: string;
}

export interface StudyQuestion {
  id: string;
  kind: "scale" | "choice" | "text";
  text: string;
  /** Of scales: whole numbers, and what stands at their ends. */
  low?: number;
  high?: number;
  low_text?: string;
  high_text?: string;
  choices?: readonly StudyChoice[];
  /** Of texts: characters. */
  longest?: number;
}

/** The question of blind identification: it has to be answered. */
export const kIdentifyQuestion = "identify";

/** What a participant is told, and all that a participant's client knows. */
export interface ParticipantState {
  view: "participant";
  title: string;
  language: string;
  languages: readonly string[];
  phase: StudyPhase;
  /** In `training`: it has begun. */
  is_running: boolean;
  /** From 1; null where the study does not say how far it is. */
  trial: number | null;
  trials: number | null;
  /** The product is open: the session can begin. */
  is_open: boolean;
  /** By language: the participant chooses one with the consent. */
  consent: Readonly<Record<string, string>> | null;
  instruction: string | null;
  method: "hand" | "picking" | null;
  occurrence: number | null;
  /** For participants only where the protocol does not hide it. */
  condition_name?: string | null;
  elapsed_s: number | null;
  limit_s: number | null;
  question: StudyQuestion | null;
}

export type TrialOutcome = "done" | "timed_out" | "not_done";

export interface FinishedTrial {
  trial: number;
  condition: string;
  repetition: number;
  outcome: TrialOutcome;
  time_s: number | null;
  collisions: number | null;
  peak_force_n: number | null;
  /** Of blind identification. */
  answer: string | null;
  is_right: boolean | null;
}

export type AnswerValue = number | string | null;

export interface StudyNote {
  text: string;
  /** That was at hand. */
  trial: number | null;
  /** When it was written, on the server's wall clock. */
  unix_ms: number;
}

export interface ExperimenterState extends Omit<ParticipantState, "view"> {
  view: "experimenter";
  participant: string;
  is_resumed: boolean;
  interruptions: number;
  protocol: string;
  digest: string;
  folder: string;
  condition: string | null;
  fit: string | null;
  repetition: number | null;
  block: string | null;
  is_identification: boolean;
  next: { condition: string; repetition: number } | null;
  /** State of the held part. */
  hold: HoldState | null;
  done: readonly FinishedTrial[];
  answers: readonly { question: string; value: AnswerValue }[];
  notes: readonly StudyNote[];
  /** Of the last abort, in `paused`. */
  reason: string | null;
  /** The participant's link, from `/` on. */
  link?: string | null;
}

export type StudyState = ParticipantState | ExperimenterState;

export type StudyCommand = { command: "study" } & (
  | { action: "state" }
  | { action: "begin" }
  | { action: "consent"; agreed: boolean; language: string }
  | { action: "ready" }
  | { action: "next" }
  | { action: "answer"; question: string; value: AnswerValue }
  | { action: "pick"; a: FaceOf; b: FaceOf }
  | { action: "note"; text: string }
  | { action: "abort"; reason: string }
  | { action: "resume" }
);

export interface StudyReply {
  state: StudyState;
  /** Of `pick`: whether the two faces made a constraint that was missing, and how many still are. */
  is_set?: boolean;
  left?: number;
}
