import { describe, expect, it } from "vitest";
import { Playback } from "../src/model/playback";
import { makeRun } from "../src/model/recordings";
import { decodeMoment, decodeView, encodeMoment } from "../src/model/view_link";
import { FrameStore } from "../src/protocol/frame_store";
import { FrameCursor, RecordedFrames } from "../src/protocol/recorded_frames";
import type { RecordedEvent } from "../src/protocol/messages";
import { kPeriodNs, positionAt, toyDetail, toyFrames, toyScene } from "./toy_recording";

const kMoments = 700;
const touches = (moment: number) => ({ contact_count: moment % 100 < 10 ? 1 : 0 });

function whereIs(store: FrameStore, occurrence: number): number {
  const pose = new Float32Array(7);
  store.readPose(occurrence, pose);
  return pose[0] ?? NaN;
}

describe("the frames of a recording", () => {
  const frames = new RecordedFrames(toyFrames(kMoments, touches), 77);

  it("are moments with a time each", () => {
    expect(frames.count).toBe(kMoments);
    expect(frames.isWhole).toBe(true);
    expect(frames.timesS[60]).toBeCloseTo((60 * kPeriodNs) / 1e9, 12);
    expect(frames.momentAt(-1)).toBe(0);
    expect(frames.momentAt(frames.timesS[60]!)).toBe(60);
    expect(frames.momentAt(frames.timesS[60]! - 1e-6)).toBe(59);
    expect(frames.momentAt(1e9)).toBe(kMoments - 1);
  });

  it("give the same state by any order of seeks as by playing", () => {
    const played = new FrameCursor(frames);
    const sought = new FrameCursor(frames);
    // A fixed walk over all distances, forward and back, across keys and beside them.
    const order = [0, 699, 1, 128, 127, 129, 500, 499, 498, 300, 640, 641, 639, 5, 255, 256, 257, 0, 384];
    let random = 12345;
    for (let k = 0; k < 300; k++) {
      random = (random * 1103515245 + 12345) % 2147483648;
      order.push(random % kMoments);
    }
    const states: string[] = [];
    for (let moment = 0; moment < kMoments; moment++) {
      played.goTo(moment);
      states.push(JSON.stringify(stateOf(played.store)));
    }
    for (const moment of order) {
      sought.goTo(moment);
      expect(JSON.stringify(stateOf(sought.store)), `moment ${moment}`).toBe(states[moment]);
    }
  });

  function stateOf(store: FrameStore) {
    const live = store.read();
    return { places: [0, 1, 2].map((id) => whereIs(store, id)), hands: live?.hands, contacts: live?.contacts };
  }

  it("are where the toy was", () => {
    const cursor = new FrameCursor(frames);
    for (const moment of [650, 13, 128]) {
      cursor.goTo(moment);
      for (const id of [0, 1, 2]) {
        expect(whereIs(cursor.store, id)).toBeCloseTo(positionAt(id, moment), 6);
      }
    }
  });

  it("belong to a scene that no server has", () => {
    const cursor = new FrameCursor(frames);
    cursor.goTo(3);
    expect(cursor.store.epoch).toBe(77);
    expect(cursor.store.read()?.seq).toBe(4);
  });

  it("end where the file was cut off", () => {
    const cut = new RecordedFrames(toyFrames(10).slice(0, -20), 1);
    expect(cut.isWhole).toBe(false);
    expect(cut.count).toBe(10);
    const none = new RecordedFrames(new ArrayBuffer(0), 1);
    expect(none.count).toBe(0);
    expect(new FrameCursor(none).goTo(0)).toBe(false);
  });
});

const seconds = (moment: number) => moment * kPeriodNs;
const events: RecordedEvent[] = [
  { event: "taken", hand: 0, occurrence: 1, state: 1, t_ns: seconds(30) },
  { event: "placement", occurrence: 1, placement: "held", t_ns: seconds(30) },
  { event: "state", hand: 0, occurrence: 1, state: 3, t_ns: seconds(100) },
  { event: "safety", reasons: ["kicked"], gate_actions: 1 << 12, t_ns: seconds(150) },
  { event: "state", hand: 0, occurrence: 1, state: 5, t_ns: seconds(200) },
  {
    event: "dropped",
    hand: 0,
    occurrence: 1,
    state: 0,
    was_seated: true,
    metrics: { time_s: 3, path_mm: 900, peak_true_n: 40, peak_felt_n: 5, fit_true_n: 30, depth_um: 3, insertion_mm: 50, collisions: 2 },
    t_ns: seconds(220),
  },
  { event: "placement", occurrence: 1, placement: "placed", t_ns: seconds(220) },
  { event: "step", index: 2, total: 3, t_ns: seconds(220) },
];

function makePlayback(moments = 400): Playback {
  const durationS = (moments * kPeriodNs) / 1e9;
  return new Playback(makeRun(toyDetail(events, durationS), toyFrames(moments, touches)), toyScene, 1_700_000_000_000);
}

describe("a playback", () => {
  it("has the product of the recording under an epoch of its own", () => {
    const playback = makePlayback();
    expect(playback.scene.value).toMatchObject({ name: "toy", glb: "/api/recording/r1/model.glb" });
    expect(playback.scene.value?.epoch).toBe(playback.store.epoch);
    expect(playback.scene.value?.epoch).not.toBe(makePlayback().scene.value?.epoch);
  });

  it("shows the work as it was at each moment, forward and back", () => {
    const playback = makePlayback();
    expect(playback.placements.value.get(1)).toBe("loose");
    playback.seek(seconds(250) / 1e9);
    expect(playback.placements.value.get(1)).toBe("placed");
    expect(playback.step.value).toEqual({ index: 2, total: 3 });
    expect(playback.runs.value).toMatchObject([{ name: "part 1", wasSeated: true, metrics: { peak_true_n: 40 } }]);
    expect(playback.log.value.map((entry) => entry.kind)).toEqual(["dropped", "state", "safety", "state", "taken"]);
    playback.seek(seconds(50) / 1e9);
    expect(playback.placements.value.get(1)).toBe("held");
    expect(playback.runs.value).toEqual([]);
    expect(playback.log.value[0]?.at.getTime()).toBe(1_700_000_000_000 + 500);
  });

  it("goes on by the time that has gone by, as fast as it is told, and stops at the end", () => {
    const playback = makePlayback();
    playback.speed.value = 2;
    playback.play();
    playback.tick(1000);
    playback.tick(1100);
    playback.tick(1200);
    expect(playback.timeS).toBeCloseTo(0.4, 9);
    playback.tick(60_000);
    expect(playback.timeS, "no jump after a pause of the page").toBeCloseTo(2.4, 9);
    playback.seek(playback.durationS - 0.1);
    playback.tick(60_100);
    expect(playback.timeS).toBe(playback.durationS);
    expect(playback.isPlaying.value).toBe(false);
    playback.play();
    expect(playback.timeS).toBe(0);
  });

  it("steps from frame to frame", () => {
    const playback = makePlayback();
    playback.stepFrames(5);
    expect(playback.timeS).toBeCloseTo(seconds(5) / 1e9, 9);
    playback.stepFrames(-1);
    expect(playback.timeS).toBeCloseTo(seconds(4) / 1e9, 9);
    playback.stepFrames(-100);
    expect(playback.timeS).toBe(0);
    playback.stepFrames(1e6);
    expect(whereIs(playback.store, 1)).toBeCloseTo(positionAt(1, 399), 6);
  });

  it("marks what happened, contacts as well", () => {
    const { marks } = makePlayback();
    expect(marks.filter((m) => m.kind !== "contact").map((m) => m.kind)).toEqual([
      "taken",
      "captured",
      "safety",
      "seated",
      "dropped",
    ]);
    expect(marks.filter((m) => m.kind === "contact").map((m) => Math.round((m.timeS * 1e9) / kPeriodNs))).toEqual([
      0, 100, 200, 300,
    ]);
  });

  it("goes through a link and comes back", () => {
    const fragment = `#view&eye=1,2,3&to=0,0,0${encodeMoment({ recording: "a b", timeS: 12.3456 })}`;
    expect(decodeMoment(fragment)).toEqual({ recording: "a b", timeS: 12.346 });
    expect(decodeView(fragment)?.eye).toEqual([1, 2, 3]);
    expect(decodeMoment("#view&eye=1,2,3&to=0,0,0")).toBeNull();
    expect(decodeMoment("#view&rec=x&at=-3")).toBeNull();
  });
});
