import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { t } from "../src/app/i18n";
import { makeHint } from "../src/model/hints";
import { Studio } from "../src/model/studio";
import { buildTree, filterTree, groupAround } from "../src/model/tree";
import { decodeView, encodeView, takeToken, withToken, type SharedView } from "../src/model/view_link";
import { isolate, makeViewState, select, setHidden } from "../src/model/view_state";
import type { HandSetup, Scene } from "../src/protocol/messages";
import { makePart } from "./toy_part";

const scene: Scene = {
  epoch: 1,
  name: "pump",
  source: "pump.step",
  glb: "/api/model/0.glb",
  triangles: 10,
  table_z_m: 0,
  centre_m: [0, 0, 0],
  radius_m: 0.1,
  seed: "1",
  next_step: 1,
  pending: 0,
  subassemblies: [
    { id: 0, parent: null, name: "pump", subassemblies: [1], occurrences: [0, 1] },
    { id: 1, parent: 0, name: "fasteners", subassemblies: [], occurrences: [2, 3, 4] },
  ],
  occurrences: [
    makePart(0, "housing", 0, { is_base: true, placement: "placed" }),
    makePart(1, "shaft", 1),
    makePart(2, "bolt 1", 2, { parent: 1 }),
    makePart(3, "bolt 2", 2, { parent: 1 }),
    makePart(4, "bolt 3", 2, { parent: 1 }),
  ],
  mates: [],
  left_out: [],
  steps: [
    { kind: "base", occurrence: 0, members: [], way_in: [0, 0, -1], distance_m: 0 },
    { kind: "insert", occurrence: 1, members: [], way_in: [0, 0, -1], distance_m: 0.05 },
  ],
  diagnostics: [],
};

function handWith(index: number, condition: string): HandSetup {
  const device = { index, name: `device ${index}`, model: "", serial: "", is_emulated: false, has_force: true, has_torque: false };
  return { hand: 0, device: { ...device, max_force_n: null, scale: null, notes: [] }, condition, lease: null };
}

describe("a click on a part, by subassemblies", () => {
  it("selects the one that it stands in, then the one around that up to the product, and begins anew", () => {
    const first = groupAround(scene, 3, []);
    expect(first.sort()).toEqual([2, 3, 4]);
    const second = groupAround(scene, 3, first);
    expect(second.sort()).toEqual([0, 1, 2, 3, 4]);
    expect(groupAround(scene, 3, second).sort()).toEqual([2, 3, 4]);
  });
});

describe("the tree", () => {
  it("gathers like parts and leaves out the root", () => {
    const nodes = buildTree(scene);
    expect(nodes.map((n) => n.name)).toEqual(["fasteners", "housing", "shaft"]);
    expect(nodes[0]?.children).toMatchObject([{ kind: "group", name: "bolt", occurrences: [2, 3, 4] }]);
  });

  it("keeps the way to what is searched", () => {
    const found = filterTree(buildTree(scene), "BOLT 2");
    expect(found).toHaveLength(1);
    expect(found[0]?.occurrences).toEqual([3]);
  });
});

describe("the view", () => {
  it("adds to the selection and takes from it", () => {
    const view = makeViewState();
    select(view, [1, 2], false);
    select(view, [3], true);
    expect(view.selected.value).toEqual([1, 2, 3]);
    select(view, [1, 3], true);
    expect(view.selected.value).toEqual([2]);
  });

  it("isolates, and the second time shows all", () => {
    const view = makeViewState();
    isolate(view, [1], [0, 1, 2]);
    expect([...view.hidden.value]).toEqual([0, 2]);
    isolate(view, [1], [0, 1, 2]);
    expect(view.hidden.value.size).toBe(0);
    setHidden(view, [2], true);
    expect([...view.hidden.value]).toEqual([2]);
  });

  it("goes through a link and comes back", () => {
    const shared: SharedView = {
      eye: [0.1, -0.25, 0.3],
      target: [0, 0, 0.05],
      isOrthographic: true,
      hidden: [3, 5],
      ghosted: [7],
      selected: [1],
      explode: 0.4,
      section: { axis: 2, offset: -0.25, isFlipped: true },
    };
    expect(decodeView(`#${encodeView(shared)}`)).toEqual(shared);
    const { token, rest } = takeToken(`#${withToken("ab-_9", encodeView(shared))}`);
    expect(token).toBe("ab-_9");
    expect(decodeView(rest)).toEqual(shared);
  });

  it("takes nothing from fragments that are not its own", () => {
    expect(decodeView("#t=secret")).toBeNull();
    expect(takeToken("#t=secret")).toEqual({ token: "secret", rest: "" });
    expect(takeToken("#view&eye=1,2,3&to=0,0,0")).toEqual({ token: null, rest: "view&eye=1,2,3&to=0,0,0" });
    expect(takeToken("")).toEqual({ token: null, rest: "" });
    expect(decodeView("#view&eye=1,2&to=0,0,0")).toBeNull();
    expect(decodeView("#view&eye=1,2,3&to=0,0,0&cut=9,4,1")?.section).toBeNull();
  });
});

describe("hints", () => {
  const base = { scene, expected: 1, isDone: false, canSteer: true };

  it("name the part whose turn it is", () => {
    expect(makeHint({ ...base, held: null })).toMatchObject({ key: "hint.emptyExpected", params: { expected: "shaft" } });
  });

  it("follow the state of what is held", () => {
    const held = { occurrence: 1, state: "mating", mate: null } as const;
    expect(makeHint({ ...base, held })).toMatchObject({ key: "hint.matingPlace", params: { part: "shaft" } });
  });

  it("have no gap where it is not known what the part is near to", () => {
    const mate = { id: 4, a: 0, b: 1 } as Scene["mates"][number];
    for (const state of ["free", "near", "captured", "mating", "seated"] as const) {
      for (const scenes of [scene, { ...scene, mates: [mate] }]) {
        const hint = makeHint({ ...base, scene: scenes, held: { occurrence: 1, state, mate: 4 } });
        const text = t(hint.key, hint.params);
        expect(text, state).not.toMatch(/ \.|\{| ,|\s:/);
      }
    }
  });

  it("tell a viewer that he watches, and everyone when all is done", () => {
    expect(makeHint({ ...base, held: null, canSteer: false }).key).toBe("hint.viewer");
    expect(makeHint({ ...base, held: null, isDone: true }).key).toBe("hint.done");
  });
});

/** The worker that would hold the socket. */
class FakeWorker {
  static last: FakeWorker;
  sent: { type: string; text?: string }[] = [];
  onmessage: (event: { data: unknown }) => void = () => {};

  constructor() {
    FakeWorker.last = this;
  }

  postMessage(message: { type: string; text?: string }): void {
    this.sent.push(message);
  }

  say(message: unknown): void {
    this.reply({ type: "text", text: JSON.stringify(message) });
  }

  reply(data: unknown): void {
    this.onmessage({ data });
  }
}

describe("the session", () => {
  beforeEach(() => {
    vi.stubGlobal("Worker", FakeWorker);
    vi.stubGlobal("location", { href: "http://localhost/" });
    vi.stubGlobal("fetch", async () => ({ ok: true, status: 200, json: async () => structuredClone(scene) }));
  });
  afterEach(() => vi.unstubAllGlobals());

  async function start(): Promise<Studio> {
    const studio = new Studio();
    await studio.start("token");
    FakeWorker.last.onmessage({ data: { type: "open" } });
    FakeWorker.last.say({
      event: "hello",
      version: 1,
      role: "operator",
      client: "c5",
      has_lease: true,
      examples: [],
      forces_off: false,
      has_scene: true,
    });
    await vi.waitFor(() => expect(studio.store.scene.value).not.toBeNull());
    return studio;
  }

  it("keeps what it is told while the scene is on its way, which may be older", async () => {
    let answer: (value: unknown) => void = () => {};
    const onTheWay = new Promise((resolve) => (answer = resolve));
    vi.stubGlobal("fetch", (path: string) => (path === "/api/scene" ? onTheWay : Promise.resolve({ ok: true, status: 200, json: async () => ({}) })));
    const studio = new Studio();
    await studio.start("token");
    FakeWorker.last.say({ event: "hello", version: 1, role: "operator", client: "c5", has_lease: true, examples: [], forces_off: false, has_scene: true });
    FakeWorker.last.say({ event: "placement", occurrence: 1, placement: "placed" });
    FakeWorker.last.say({ event: "step", index: 1, total: 2 });
    answer({ ok: true, status: 200, json: async () => structuredClone(scene) });
    await vi.waitFor(() => expect(studio.store.scene.value).not.toBeNull());
    expect(studio.store.placements.value.get(1)).toBe("placed");
    expect(studio.store.step.value).toEqual({ index: 1, total: 2 });
  });

  it("mirrors what the server says", async () => {
    const { store } = await start();
    expect(store.expected.value?.occurrence).toBe(1);
    FakeWorker.last.say({ event: "placement", occurrence: 1, placement: "placed" });
    expect(store.placements.value.get(1)).toBe("placed");
    FakeWorker.last.say({ event: "roles", clients: [{ id: "c5", role: "operator", has_lease: false }] });
    expect(store.hasLease.value).toBe(false);
    FakeWorker.last.say({ event: "forces", off: true, by: "c2" });
    expect(store.forcesOff.value).toBe(true);
  });

  it("knows its hands, the trouble with their devices, and that it is recorded", async () => {
    const { store } = await start();
    expect(store.ownHands.value).toEqual([0]);
    FakeWorker.last.say({ event: "roles", clients: [{ id: "c5", role: "operator", has_lease: false, hands: [1] }] });
    expect(store.ownHands.value).toEqual([1]);
    FakeWorker.last.say({ event: "device", hand: 1, condition: "lost", text: "is disconnected; connect it again" });
    expect(store.deviceTroubles.value.get(1)).toMatch(/connect it again/);
    FakeWorker.last.say({ event: "device", hand: 1, condition: "ready", text: "is ready" });
    expect(store.deviceTroubles.value.size).toBe(0);
    FakeWorker.last.say({ event: "device", hand: 0, condition: "fault", text: "renders no force" });
    FakeWorker.last.say({ event: "hands", hands: [handWith(7, "fault")] });
    expect(store.deviceTroubles.value.get(0)).toBe("renders no force");
    FakeWorker.last.say({ event: "hands", hands: [handWith(0, "ready")] });
    expect(store.deviceTroubles.value.size).toBe(0);
    FakeWorker.last.say({ event: "recording", on: true, id: "r1", name: "First", t_s: 0 });
    expect(store.recording.value?.name).toBe("First");
    expect(store.log.value[0]).toMatchObject({ kind: "recording", params: { on: 1, name: "First" } });
  });

  it("raises an alarm for what cuts the force, not for what limits it", async () => {
    const { store } = await start();
    FakeWorker.last.say({ event: "safety", reasons: ["comes in slowly"], gate_actions: 1 << 4 });
    expect(store.safety.value).toBeNull();
    FakeWorker.last.say({ event: "safety", reasons: ["kicked"], gate_actions: 1 << 12 });
    expect(store.safety.value).toEqual({ reasons: ["kicked"] });
    FakeWorker.last.say({ event: "taken", hand: 0, occurrence: 1, state: "free" });
    expect(store.safety.value).toBeNull();
  });

  it("shows why a file could not be opened, unless somebody has stopped it", async () => {
    const { store } = await start();
    const error = { code: "cancelled", message: "opening the file was cancelled", where: "a.step", remedy: "" };
    FakeWorker.last.say({ event: "progress", stage: "read", fraction: 0.1, file: "a.step" });
    FakeWorker.last.say({ event: "failed", error });
    expect(store.loading.value).toBeNull();
    expect(store.failure.value).toBeNull();
    expect(store.log.value[0]).toMatchObject({ kind: "stopped" });
    FakeWorker.last.say({ event: "failed", error: { ...error, code: "invalid" } });
    expect(store.failure.value?.code).toBe("invalid");
    expect(store.log.value[0]).toMatchObject({ kind: "failed" });
  });

  it("tells a change of the product from one that was opened", async () => {
    const { store } = await start();
    FakeWorker.last.say({ event: "scene", epoch: 8, why: "fit m0=H7/g6" });
    expect(store.log.value[0]).toMatchObject({ kind: "changed", params: { what: "fit m0=H7/g6" } });
    FakeWorker.last.say({ event: "scene", epoch: 9, why: null });
    expect(store.log.value[0]).toMatchObject({ kind: "opened" });
    FakeWorker.last.say({ event: "resumed", is_resumed: true, seated: 3, edits: 1 });
    expect(store.log.value[0]).toMatchObject({ kind: "resumed", params: { isResumed: 1, seated: 3, edits: 1 } });
  });

  it("counts limits of the force beside the log, and alarms in one entry", async () => {
    const { store } = await start();
    const before = store.log.value.length;
    for (let k = 0; k < 70; k++) {
      FakeWorker.last.say({ event: "safety", reasons: k % 2 === 0 ? ["too large"] : ["too large", "too sudden"], gate_actions: 1 << 4 });
    }
    expect(store.log.value.length).toBe(before);
    expect([...store.limits.value]).toEqual([["too large", 70], ["too sudden", 35]]);
    for (let k = 0; k < 3; k++) {
      FakeWorker.last.say({ event: "safety", reasons: ["client silent"], gate_actions: 1 << 7 });
    }
    FakeWorker.last.say({ event: "safety", reasons: ["kicked"], gate_actions: 1 << 12 });
    expect(store.log.value.slice(0, 2)).toMatchObject([{ params: { text: "kicked" } }, { params: { text: "client silent" }, count: 3 }]);
    expect(store.log.value.length).toBe(before + 2);
    expect(store.limits.value.size).toBe(2);
  });

  it("says that it is not let in any more where the server has other links, and comes back where it has the same", async () => {
    const { store } = await start();
    const error = { code: "invalid", message: "this browser has no session", where: "", remedy: "open the link" };
    FakeWorker.last.reply({ type: "closed" });
    expect(store.link.value).toBe("lost");
    vi.stubGlobal("fetch", () => Promise.resolve(new Response(JSON.stringify({ error }), { status: 401 })));
    FakeWorker.last.reply({ type: "closed" });
    await vi.waitFor(() => expect(store.link.value).toBe("denied"));
    expect(store.denial.value?.remedy).toBe("open the link");
    FakeWorker.last.reply({ type: "open" });
    expect(store.link.value).toBe("open");
  });

  it("answers each command once, and shows a refusal", async () => {
    const studio = await start();
    const answer = studio.command({ command: "take", hand: 0, occurrence: 1 });
    const sent = JSON.parse(FakeWorker.last.sent.at(-1)?.text ?? "{}") as { id: number };
    FakeWorker.last.say({ id: sent.id, ok: true, result: { hand: { p: [1, 2, 3], q: [1, 0, 0, 0] } } });
    expect((await answer)?.hand.p).toEqual([1, 2, 3]);
    const refused = studio.command({ command: "undo" });
    const second = JSON.parse(FakeWorker.last.sent.at(-1)?.text ?? "{}") as { id: number };
    FakeWorker.last.say({ id: second.id, ok: false, error: { code: "x", message: "No.", where: "", remedy: "Wait." } });
    expect(await refused).toBeNull();
    expect(studio.store.notice.value).toMatchObject({ text: "No. Wait.", isError: true });
  });

  it("passes over events of a newer server", async () => {
    await start();
    expect(() => FakeWorker.last.say({ event: "unheard-of" })).not.toThrow();
  });
});
