// A tiny study for the mock: consent, training, a trial by hand, one to identify, one by picking, two questions.
// Phases, actions and views are those of docs/protocol.md; one scene and one toy serve all conditions.

/** What a hand does, in the order of the numbers of frames and events. */
const HOLD_STATES = ["empty", "free", "near", "captured", "mating", "seated"];
const CONDITIONS = {
  A1: { name: "Constraints by mouse", method: "picking", fit: "H7/g6" },
  B1: { name: "Clearance", method: "hand", fit: "H7/g6" },
  B2: { name: "Interference", method: "hand", fit: "H7/p6" },
};
const TRIALS = [
  { condition: "B1", repetition: 1, block: "timed" },
  { condition: "B2", repetition: 1, block: "blind", identify: true },
  { condition: "A1", repetition: 1, block: "timed" },
];
const QUESTIONS = [
  { id: "steady", kind: "scale", low: 1, high: 10 },
  { id: "remarks", kind: "text", longest: 200 },
];
const WORDS = {
  en: {
    instruction: { hand: "Put the shaft into the bushing.", picking: "Pick the surfaces that belong together." },
    training: "Put the shaft into the bushing, as often as you like.",
    identify: "Which fit was it?",
    steady: { text: "How steady and continuous did the force feel?", low_text: "not at all", high_text: "completely" },
    remarks: { text: "Is there anything else that you noticed?" },
  },
  de: {
    instruction: { hand: "Setzen Sie die Welle in die Buchse.", picking: "Wählen Sie die Flächen, die zusammengehören." },
    training: "Setzen Sie die Welle in die Buchse, sooft Sie mögen.",
    identify: "Welche Passung war es?",
    steady: { text: "Wie stetig und gleichmäßig fühlte sich die Kraft an?", low_text: "gar nicht", high_text: "völlig" },
    remarks: { text: "Ist Ihnen sonst noch etwas aufgefallen?" },
  },
};
const CONSENT = {
  en:
    "You will put a shaft into a bushing with a device that can push back. We want to know how well different fits " +
    "can be told apart by feel. The session takes about an hour.\n\nWe record the motion of your hand, the force of " +
    "the device, times and your answers, under a number and not under your name. You may stop at any time, without " +
    "giving a reason, and have everything deleted.\n\nThe device stops at once when you let go of it or press Esc.",
  de:
    "Sie setzen eine Welle in eine Buchse, mit einem Gerät, das zurückdrückt. Wir möchten wissen, wie gut sich " +
    "verschiedene Passungen durch Fühlen unterscheiden lassen. Die Sitzung dauert etwa eine Stunde.\n\nWir zeichnen " +
    "die Bewegung Ihrer Hand, die Kraft des Geräts, Zeiten und Ihre Antworten auf, unter einer Nummer und nicht unter " +
    "Ihrem Namen. Sie können jederzeit ohne Angabe von Gründen aufhören und alles löschen lassen.\n\nDas Gerät " +
    "hält sofort an, wenn Sie es loslassen oder Esc drücken.",
};
const LIMIT_S = 120;
const TRAINING_S = 600;
const MAY = {
  participant: ["state", "consent", "ready", "answer", "pick"],
  operator: ["state", "begin", "ready", "next", "note", "abort", "resume"],
  viewer: ["state"],
};

const refusal = (message, remedy) => ({ error: { code: "invalid", message, where: "study", remedy } });

export class MockStudy {
  /** @param bench  begin(isTraining): lays the parts out, and the trial begins when it has; end(). */
  constructor({ onChange, bench, occurrence, link }) {
    Object.assign(this, { onChange, bench, occurrence, link });
    this.agenda = [
      { kind: "consent" },
      { kind: "training" },
      ...TRIALS.flatMap((trial, index) => [
        { kind: "trial", index },
        ...(trial.identify ? [{ kind: "identify", index }] : []),
      ]),
      ...QUESTIONS.map((question) => ({ kind: "question", question, index: TRIALS.length - 1 })),
    ];
    Object.assign(this, { at: 0, hasBegun: false, isRunning: false, isPaused: false, hasDeclined: false });
    Object.assign(this, { language: "en", done: [], answers: [], notes: [], interruptions: 0, reason: null });
    this.startedMs = null;
    this.left = 0;
    this.hold = null;
  }

  get item() {
    return this.agenda[this.at] ?? null;
  }

  get phase() {
    if (this.hasDeclined) {
      return "declined";
    }
    if (this.isPaused) {
      return "paused";
    }
    if (!this.hasBegun) {
      return "waiting";
    }
    const phases = { consent: "consent", training: "training", trial: this.isRunning ? "running" : "ready" };
    return this.item === null ? "done" : (phases[this.item.kind] ?? "question");
  }

  get trial() {
    return this.item?.index ?? null;
  }

  get condition() {
    return this.item?.kind === "training" ? "B1" : this.trial === null ? null : TRIALS[this.trial].condition;
  }

  get isTask() {
    return this.isRunning && ["training", "running"].includes(this.phase);
  }

  /** @return What the command's answer is made of: {result} or {error}. */
  do(role, { action, ...fields }) {
    if (!MAY[role].includes(action)) {
      return refusal("this link may not do that", "see docs/protocol.md");
    }
    const refused = this[`on_${action}`]?.(fields);
    if (refused?.error) {
      return refused;
    }
    if (action !== "state") {
      this.onChange();
    }
    return { result: { ...refused, state: this.state(role) } };
  }

  on_begin() {
    this.hasBegun = true;
  }

  on_consent({ agreed, language }) {
    if (this.phase !== "consent") {
      return refusal("consent is not possible now", "");
    }
    this.language = language;
    this.hasDeclined = !agreed;
    this.at += agreed ? 1 : 0;
  }

  on_ready() {
    if (!["training", "ready"].includes(this.phase) || this.isRunning) {
      return refusal("to begin is not possible now", "wait for the trial");
    }
    this.isRunning = true;
    this.left = 2;
    this.bench.begin();
  }

  /** The parts are laid out: the clock runs. */
  began() {
    this.startedMs = Date.now();
    this.onChange();
  }

  on_next() {
    if (!this.isTask) {
      return refusal("this is not possible now", "it ends a training or a trial that runs");
    }
    this.finish("not_done");
  }

  finish(outcome) {
    if (this.item.kind === "training" && outcome === "done") {
      this.bench.begin();
      return;
    }
    if (this.item.kind === "trial") {
      const { condition, repetition } = TRIALS[this.trial];
      const time_s = outcome === "done" ? (Date.now() - this.startedMs) / 1e3 : null;
      this.done.push({ trial: this.trial + 1, condition, repetition, outcome, time_s, collisions: 2, peak_force_n: 3.14, answer: null, is_right: null });
    }
    this.stop();
    this.at += 1;
  }

  stop() {
    this.isRunning = false;
    this.startedMs = null;
    this.hold = null;
    this.bench.end();
  }

  on_answer({ question, value }) {
    const { item } = this;
    const wanted = item?.kind === "identify" ? "identify" : item?.question?.id;
    if (this.phase !== "question" || question !== wanted) {
      return refusal("this is not asked now", "");
    }
    if (item.kind === "identify") {
      Object.assign(this.done.at(-1), { answer: value, is_right: value === CONDITIONS[this.condition].fit });
    } else {
      this.answers.push({ question, value });
    }
    this.at += 1;
  }

  on_pick({ a, b }) {
    if (!this.isTask || CONDITIONS[this.condition].method !== "picking") {
      return refusal("to pick is not possible now", "");
    }
    const is_set = [a, b].filter((face) => face.occurrence === this.occurrence).length === 1;
    this.left -= is_set ? 1 : 0;
    const { left } = this;
    if (left === 0) {
      this.finish("done");
    }
    return { is_set, left };
  }

  on_note({ text }) {
    this.notes.push({ text, trial: (this.trial ?? 0) + 1, unix_ms: Date.now() });
  }

  on_abort({ reason }) {
    this.stop();
    Object.assign(this, { isPaused: true, reason, interruptions: this.interruptions + 1 });
  }

  on_resume() {
    Object.assign(this, { isPaused: false, reason: null });
  }

  /** What the toy tells of the hand. */
  noteHold({ event, occurrence, state }) {
    if (!this.isTask || occurrence !== this.occurrence || !["state", "taken", "dropped"].includes(event)) {
      return;
    }
    this.hold = event === "dropped" ? null : HOLD_STATES[state];
    if (this.hold === "seated") {
      this.finish("done");
    }
    this.onChange();
  }

  question() {
    const words = WORDS[this.language];
    if (this.phase !== "question") {
      return null;
    }
    if (this.item.kind === "identify") {
      const choices = ["H7/g6", "H7/p6"].map((id) => ({ id, text: id }));
      return { id: "identify", kind: "choice", text: words.identify, choices };
    }
    return { ...this.item.question, ...words[this.item.question.id] };
  }

  state(role) {
    const { phase, condition, trial, isTask } = this;
    const isAtHand = ["training", "ready", "running"].includes(phase);
    const isTraining = phase === "training";
    const words = WORDS[this.language];
    const method = isAtHand ? CONDITIONS[condition].method : null;
    const state = {
      event: "study",
      view: role === "operator" ? "experimenter" : "participant",
      title: this.language === "de" ? "Passungen, die man fühlt" : "Fits that are felt",
      language: this.language,
      languages: ["en", "de"],
      phase,
      is_running: this.isRunning,
      is_open: true,
      trial: trial === null ? null : trial + 1,
      trials: TRIALS.length,
      consent: phase === "consent" ? CONSENT : null,
      instruction: isAtHand ? (isTraining ? words.training : words.instruction[method]) : null,
      method,
      occurrence: isAtHand ? this.occurrence : null,
      elapsed_s: isTask && this.startedMs !== null ? (Date.now() - this.startedMs) / 1e3 : null,
      has_end_sound: true,
      stereo: "none",
      limit_s: isAtHand ? (isTraining ? TRAINING_S : LIMIT_S) : null,
      question: this.question(),
    };
    return role === "operator" ? { ...state, ...this.forExperimenter() } : state;
  }

  forExperimenter() {
    const { condition, trial } = this;
    const next = trial === null ? undefined : TRIALS[trial + 1];
    return {
      participant: "P01",
      is_resumed: false,
      interruptions: this.interruptions,
      protocol: "mock",
      digest: "9f2c51d0a7e34b68",
      folder: "/home/lab/studies/mock",
      condition,
      condition_name: condition && CONDITIONS[condition].name,
      fit: condition && CONDITIONS[condition].fit,
      repetition: trial === null ? null : TRIALS[trial].repetition,
      block: trial === null ? null : TRIALS[trial].block,
      is_identification: trial !== null && TRIALS[trial].identify === true,
      next: next ? { condition: next.condition, repetition: next.repetition } : null,
      hold: this.hold,
      done: this.done,
      answers: this.answers,
      notes: this.notes,
      reason: this.isPaused ? this.reason : null,
      link: this.link,
    };
  }
}

const PARTICIPANTS = ["hello", "study", "scene", "placement", "taken", "dropped", "state", "forces", "hands", "roles"];

/** What of an event a role is sent; null: nothing. */
export function eventFor(role, event) {
  if (role === "operator") {
    return event;
  }
  if (!PARTICIPANTS.includes(event.event)) {
    return null;
  }
  const { metrics, ...rest } = event;
  return rest;
}

export function sceneFor(role, scene) {
  if (role === "operator") {
    return scene;
  }
  const { seed, ...rest } = scene;
  return { ...rest, diagnostics: [], mates: scene.mates.map((mate) => ({ ...mate, fit: null, evidence: "" })) };
}

/** No force but that which is felt. */
export function handFor(role, hand) {
  return role === "operator" ? hand : { ...hand, f_true_W_n: [0, 0, 0], t_true_W_nm: [0, 0, 0], axial_true_n: 0 };
}
