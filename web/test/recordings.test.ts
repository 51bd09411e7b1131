import { afterEach, describe, expect, it, vi } from "vitest";
import { Recordings } from "../src/model/recordings";
import { makeStore } from "../src/model/store";
import type { RecordingEntry } from "../src/protocol/messages";
import { toyDetail, toyFrames, toyScene } from "./toy_recording";

const kEntry: RecordingEntry = {
  id: "r1",
  name: "First",
  product: "toy",
  started_unix_ms: 1_700_000_000_000,
  duration_s: 5,
  is_complete: true,
  is_shared: false,
  bytes: 1000,
};

type Answers = Record<string, { json?: unknown; bytes?: ArrayBuffer; status?: number }>;

function serve(answers: Answers) {
  const fetched = vi.fn(async (address: string) => {
    const found = answers[address] ?? { status: 404, json: { error: { code: "not_found", message: "Gone.", where: "", remedy: "Take another." } } };
    const status = found.status ?? 200;
    return { ok: status < 400, status, statusText: "", json: async () => found.json, arrayBuffer: async () => found.bytes };
  });
  vi.stubGlobal("fetch", fetched);
  return fetched;
}

function makeRecordings() {
  const store = makeStore();
  store.link.value = "open";
  store.hasLease.value = true;
  store.live.scene.value = { ...toyScene, name: "what is live" };
  const studio = { command: vi.fn(async () => ({})), notify: vi.fn() };
  return { store, studio, recordings: new Recordings(store, studio as never) };
}

const kAll: Answers = {
  "/api/recordings": { json: { recordings: [{ ...kEntry, id: "r0", started_unix_ms: 1 }, kEntry] } },
  "/api/recording/r1": { json: toyDetail([], 5) },
  "/api/recording/r1/scene": { json: toyScene },
  "/api/recording/r1/frames": { bytes: toyFrames(300) },
};

describe("the recordings", () => {
  afterEach(() => vi.unstubAllGlobals());

  it("are listed, the newest first", async () => {
    serve(kAll);
    const { store, recordings } = makeRecordings();
    await recordings.fetchList();
    expect(store.recordings.value?.map((each) => each.id)).toEqual(["r1", "r0"]);
  });

  it("take the place of what is live, and give it back", async () => {
    serve(kAll);
    const { store, recordings } = makeRecordings();
    expect(await recordings.open("r1", 2)).toBe(true);
    expect(recordings.playback.value?.timeS).toBe(2);
    expect(store.scene.value?.name).toBe("toy");
    expect(store.canSteer.value, "nothing is moved in what was").toBe(false);
    recordings.close();
    expect(store.scene.value?.name).toBe("what is live");
    expect(store.canSteer.value).toBe(true);
  });

  it("are fetched once", async () => {
    const fetched = serve(kAll);
    const { recordings } = makeRecordings();
    await Promise.all([recordings.fetchRun("r1"), recordings.fetchRun("r1")]);
    await recordings.open("r1");
    expect(fetched.mock.calls.filter(([address]) => address.endsWith("/frames"))).toHaveLength(1);
  });

  it("tell what is wrong and leave what is live alone", async () => {
    serve({});
    const { store, studio, recordings } = makeRecordings();
    expect(await recordings.open("r9")).toBe(false);
    expect(studio.notify).toHaveBeenCalledWith("Gone. Take another.", true);
    expect(store.replay.value).toBeNull();
    expect(recordings.fetching.value).toBeNull();
  });

  it("that come too late are not shown", async () => {
    serve(kAll);
    const { store, recordings } = makeRecordings();
    const opening = recordings.open("r1");
    recordings.close();
    expect(await opening).toBe(false);
    expect(store.replay.value).toBeNull();
  });

  it("end with their deletion", async () => {
    serve(kAll);
    const { store, studio, recordings } = makeRecordings();
    await recordings.fetchList();
    await recordings.open("r1");
    await recordings.remove("r1");
    expect(studio.command).toHaveBeenCalledWith({ command: "delete_recording", recording: "r1" });
    expect(store.recordings.value?.map((each) => each.id)).toEqual(["r0"]);
    expect(recordings.playback.value).toBeNull();
    studio.command.mockResolvedValueOnce(null as never);
    await recordings.remove("r0");
    expect(store.recordings.value, "refused").toHaveLength(1);
  });

  it("are told of when they begin and end, and the last one is kept in mind", () => {
    const { store, recordings } = makeRecordings();
    expect(recordings.note(null)).toBeNull();
    const on = { on: true, id: "r2", name: "Second", t_s: 3 };
    expect(recordings.note(on)).toEqual({ kind: "recording", params: { on: 1, name: "Second" } });
    expect(performance.now() - (store.recording.value?.sinceMs ?? 0)).toBeGreaterThanOrEqual(3000);
    expect(recordings.note(on), "a reconnected page is told again").toBeNull();
    expect(recordings.note({ ...on, on: false })?.params["on"]).toBe(0);
    expect(recordings.lastMade.value).toBe("r2");
  });
});
