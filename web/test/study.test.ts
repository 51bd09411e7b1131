import { beforeEach, describe, expect, it } from "vitest";
import { makeStore, type Store } from "../src/model/store";
import type { Commander } from "../src/model/commander";
import { faultOf, stepsOf, StudyModel } from "../src/model/study";
import { meanTimes } from "../src/model/study_summary";
import type {
  Command,
  ExperimenterState,
  FinishedTrial,
  ParticipantState,
  StudyQuestion,
  StudyReply,
} from "../src/protocol/messages";

const told: ParticipantState = {
  view: "participant",
  title: "Fits",
  language: "en",
  languages: ["en", "de"],
  phase: "ready",
  is_running: false,
  is_open: true,
  trial: 3,
  trials: 12,
  consent: null,
  instruction: "Put it in.",
  method: "hand",
  occurrence: 2,
  elapsed_s: null,
  limit_s: 120,
  has_end_sound: true,
  stereo: "none",
  question: null,
};
const watched: ExperimenterState = {
  ...told,
  view: "experimenter",
  link: null,
  condition_name: null,
  participant: "P01",
  is_resumed: false,
  interruptions: 0,
  protocol: "fits",
  digest: "9f",
  folder: "/studies/fits",
  condition: "B1",
  fit: "H7/g6",
  repetition: 1,
  block: "timed",
  is_identification: false,
  next: null,
  hold: null,
  done: [],
  answers: [],
  notes: [],
  reason: null,
};
const running: ParticipantState = { ...told, phase: "running", elapsed_s: 10 };

/** Answers with what it was given, when it is told to. */
class FakeServer implements Commander {
  readonly sent: Command[] = [];
  reply: StudyReply | null = { state: told };
  command(command: Command): Promise<never> {
    this.sent.push(command);
    return Promise.resolve(this.reply as never);
  }
}

let store: Store;
let server: FakeServer;
let study: StudyModel;
beforeEach(() => {
  store = makeStore();
  store.role.value = "participant";
  store.link.value = "open";
  server = new FakeServer();
  study = new StudyModel(store, server);
});

describe("what is in sight", () => {
  it("is the product only while a trial or the training runs", () => {
    const shows = (change: Partial<ParticipantState>) => {
      study.take({ ...told, ...change });
      return study.isTask.value;
    };
    expect(shows({ phase: "running" })).toBe(true);
    expect(shows({ phase: "training", is_running: true })).toBe(true);
    expect(shows({ phase: "training" })).toBe(false);
    for (const phase of ["waiting", "consent", "ready", "question", "paused", "declined", "done"] as const) {
      expect(shows({ phase, is_running: true }), phase).toBe(false);
    }
  });

  it("is the participant's view for participants at once, and for those who look on when they are told", () => {
    expect(study.isParticipantView.value).toBe(true);
    store.role.value = "viewer";
    expect(study.isParticipantView.value).toBe(false);
    study.take(told);
    expect(study.isParticipantView.value).toBe(true);
    expect(study.mayAct.value).toBe(false);
    study.take(watched);
    expect(study.isParticipantView.value).toBe(false);
    expect(study.experimenter.value?.fit).toBe("H7/g6");
  });

  it("has not begun before its scene is there and its clock runs, as far as the time is told", () => {
    const scene = (epoch: number) => (store.live.scene.value = { epoch, steps: [], occurrences: [] } as never);
    scene(4);
    study.take(told);
    study.take(running);
    expect(study.isLive.value, "the scene of the trial before is still seen").toBe(false);
    study.take({ ...running, elapsed_s: null });
    scene(5);
    expect(study.isLive.value).toBe(false);
    study.take(running);
    expect(study.isLive.value).toBe(true);
    study.take(told);
    study.take({ ...running, elapsed_s: null, limit_s: null });
    expect(study.isLive.value).toBe(false);
    scene(6);
    expect(study.isLive.value).toBe(true);
  });
});

describe("the part to put in its place", () => {
  it("is the one that the study names, whatever the order of the assembly", () => {
    const step = { kind: "insert" as const, members: [], way_in: [0, 0, -1] as const, distance_m: 0.1 };
    store.live.scene.value = { steps: [{ ...step, occurrence: 1 }, { ...step, occurrence: 2 }] } as never;
    store.live.step.value = { index: 0, total: 2 };
    expect(store.expected.value?.occurrence).toBe(1);
    study.take(told);
    expect(store.expected.value?.occurrence).toBe(2);
  });

  it("is never moved by whoever watches over the study", () => {
    store.hasLease.value = true;
    expect(store.canSteer.value).toBe(true);
    expect(store.ownHands.value).toEqual([0]);
    study.take(watched);
    expect(store.canSteer.value).toBe(false);
    expect(store.ownHands.value).toEqual([]);
  });
});

describe("the time", () => {
  it("goes on between two messages, by a second at most, and ends at the limit", () => {
    study.take(running, 1000);
    expect(study.elapsedS(1000)).toBeCloseTo(10);
    expect(study.elapsedS(1400)).toBeCloseTo(10.4);
    expect(study.elapsedS(9000)).toBeCloseTo(11);
    study.take({ ...running, elapsed_s: 119.8 }, 1000);
    expect(study.elapsedS(1900)).toBe(120);
  });

  it("stands still without a connection, and is not there where it is hidden or nothing runs", () => {
    study.take(running, 1000);
    store.link.value = "lost";
    expect(study.elapsedS(1900)).toBe(10);
    study.take({ ...running, elapsed_s: null });
    expect(study.elapsedS()).toBeNull();
    study.take({ ...told, elapsed_s: 3 });
    expect(study.elapsedS()).toBeNull();
  });
});

describe("how far it is", () => {
  it("counts the trials that are over", () => {
    study.take(told);
    expect(study.progress.value).toBeCloseTo(2 / 12);
    study.take({ ...told, phase: "done", trial: 12 });
    expect(study.progress.value).toBe(1);
  });

  it("is not told where the study hides it", () => {
    study.take({ ...told, trial: null, trials: null });
    expect(study.progress.value).toBeNull();
  });
});

describe("the language", () => {
  it("is the browser's until the participant has chosen, and the server's from then on", () => {
    study = new StudyModel(store, server, ["fr-FR", "de-AT", "en"]);
    expect(study.language.value).toBeNull();
    study.take({ ...told, phase: "consent" });
    expect(study.language.value).toBe("de");
    study.chosenLanguage.value = "en";
    expect(study.language.value).toBe("en");
    study.take({ ...told, language: "de" });
    expect(study.language.value).toBe("de");
  });

  it("is one that the study has", () => {
    study = new StudyModel(store, server, ["de"]);
    study.take({ ...told, phase: "consent", languages: ["en"] });
    expect(study.language.value).toBe("en");
  });

  it("goes with the consent", async () => {
    study.take({ ...told, phase: "consent" });
    study.chosenLanguage.value = "de";
    await study.consent(true);
    expect(server.sent).toEqual([{ command: "study", action: "consent", agreed: true, language: "de" }]);
  });
});

describe("what is sent", () => {
  it("is sent once, however often the button is pressed", async () => {
    const both = await Promise.all([study.ready(), study.ready()]);
    expect(both).toEqual([true, false]);
    expect(server.sent).toHaveLength(1);
    await study.ready();
    expect(server.sent).toHaveLength(2);
  });

  it("is not held up by something else that is not answered yet", async () => {
    expect(await Promise.all([study.ready(), study.abort("smoke"), study.note("alarm")])).toEqual([true, true, true]);
    expect(study.isBusy.value).toBe(false);
  });

  it("is answered with the state that follows", async () => {
    server.reply = { state: running };
    expect(await study.ready()).toBe(true);
    expect(study.phase.value).toBe("running");
  });

  it("changes nothing where it is refused", async () => {
    study.take(told);
    server.reply = null;
    expect(await study.answer("calm", 3)).toBe(false);
    expect(study.state.value).toEqual(told);
    expect(study.isBusy.value).toBe(false);
  });

  it("tells of two faces whether they belong together, and how many are left; of each trial anew", async () => {
    const picking = { ...running, method: "picking" as const };
    study.take(picking);
    expect(study.isPicking.value).toBe(true);
    const face = { occurrence: 2, face: 1 };
    server.reply = { state: picking, is_set: false, left: 2 };
    expect(await study.pick(face, face)).toBe(false);
    server.reply = { state: picking, is_set: true, left: 1 };
    expect(await study.pick(face, face)).toBe(true);
    expect(study.leftToPick.value).toBe(1);
    study.take(picking);
    expect(study.leftToPick.value).toBe(1);
    study.take({ ...picking, trial: 4 });
    expect(study.leftToPick.value).toBeNull();
  });
});

describe("answers", () => {
  const scale: StudyQuestion = { id: "calm", kind: "scale", text: "?", low: 1, high: 10 };
  const choice: StudyQuestion = { id: "hand", kind: "choice", text: "?", choices: [{ id: "left", text: "Left" }] };
  const text: StudyQuestion = { id: "else", kind: "text", text: "?", longest: 3 };

  it("are on the scale, one of the choices, or short enough", () => {
    expect(stepsOf(scale)).toEqual([1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
    expect(faultOf(scale, 10)).toBeNull();
    expect(faultOf(scale, 11)).toBe("unknown");
    expect(faultOf(choice, "left")).toBeNull();
    expect(faultOf(choice, "right")).toBe("unknown");
    expect(faultOf(text, "äöü")).toBeNull();
    expect(faultOf(text, "😀😀😀")).toBeNull();
    expect(faultOf(text, "four")).toBe("tooLong");
  });

  it("are missed where there is none", () => {
    for (const question of [scale, choice, text]) {
      expect(faultOf(question, null)).toBe("missing");
    }
    expect(faultOf(text, "")).toBe("missing");
  });
});

describe("mean times", () => {
  it("are of the trials that were done, by condition", () => {
    const trial = (condition: string, time_s: number | null, outcome: FinishedTrial["outcome"] = "done") =>
      ({ condition, time_s, outcome }) as FinishedTrial;
    expect(meanTimes([trial("B", 4), trial("A", 120, "timed_out"), trial("B", 6), trial("B", null, "not_done")])).toEqual([
      { condition: "B", count: 2, meanS: 5 },
      { condition: "A", count: 0, meanS: null },
    ]);
  });
});
