import { afterEach, describe, expect, it } from "vitest";
import { actions } from "../src/app/actions";
import { liveTraces, store, studio, ui, view } from "../src/app/app_state";
import { plotClock, plotHands, plottedHand } from "../src/app/time_source";
import { handAfter, handOfUser } from "../src/model/hands";
import { liveMarks } from "../src/model/marks";
import { Playback } from "../src/model/playback";
import { makeRun } from "../src/model/recordings";
import { kTraceFields } from "../src/model/trace";
import { FrameStore } from "../src/protocol/frame_store";
import { kMaxHands } from "../src/protocol/frames";
import type { HandSetup } from "../src/protocol/messages";
import protocol from "../../src/studio/protocol.json";
import { handsFrame, toyDetail, toyScene } from "./toy_recording";

const kFive = [0, 1, 2, 3, 4];

function setup(hand: number): HandSetup {
  const device = { index: 0, name: "pointer", model: "", serial: "", is_emulated: false, has_force: false, has_torque: false };
  return { hand, device: { ...device, max_force_n: 0, scale: 1, notes: [] }, condition: "ready", lease: null };
}

/** A sample in which the hand touches something. */
const touching = kTraceFields.map((field) => (field === "contacts" ? 1 : 0));

describe("a page with five hands", () => {
  afterEach(() => {
    store.hands.value = [];
    store.clients.value = [];
    studio.recordings.playback.value = null;
    ui.plotHand.value = 0;
    view.hand.value = 0;
  });

  it("has room for as many as the server", () => {
    expect(kMaxHands).toBe(protocol.constants.kMaxHands);
    const frames = new FrameStore();
    frames.ingest(handsFrame(kFive), 0);
    expect(frames.read()?.hands.map(({ hand }) => hand)).toEqual(kFive);
  });

  it("lets the plots of each hand be chosen, and none that has gone", () => {
    store.hands.value = kFive.map(setup);
    expect(plotHands()).toEqual(kFive);
    ui.plotHand.value = 4;
    expect(plottedHand()).toBe(4);
    store.hands.value = [setup(0)];
    expect(plottedHand()).toBe(0);
  });

  it("lets the plots of each hand of a recording be chosen, whatever hands there are now", () => {
    store.hands.value = [setup(0)];
    const run = makeRun(toyDetail([], 1), handsFrame(kFive));
    studio.recordings.playback.value = new Playback(run, toyScene, 0);
    expect(plotHands()).toEqual(kFive);
  });

  it("has a timeline from the oldest to the newest sample of any hand, with the contacts of all", () => {
    kFive.forEach((hand) => liveTraces.of(hand).push(100 - 10 * hand, touching));
    liveTraces.of(3).push(200, touching);
    expect(plotClock()).toMatchObject({ beginS: 60, endS: 200, nowS: 200 });
    expect(liveMarks([], liveTraces.list()).map(({ timeS }) => timeS)).toEqual([60, 70, 80, 90, 100, 200]);
  });

  it("moves the mouse from one hand to the next, among those that it leads", () => {
    const all = [0, 1, 2, 3, 4, 0];
    expect(all.slice(0, -1).map((hand) => handAfter(kFive, hand))).toEqual(all.slice(1));
    expect([1, 3, 4].map((hand) => handAfter([1, 3, 4], hand))).toEqual([3, 4, 1]);
    expect(handAfter([1, 3], 0)).toBe(1);
    expect(handAfter([], 2)).toBe(2);
    store.client.value = "c1";
    store.clients.value = [{ id: "c1", name: "", role: "operator", has_lease: true, hands: [0, 2, 4] }];
    const next = actions.find(({ id }) => id === "switch-hand")!;
    const led = [1, 2, 3].map(() => {
      next.run();
      return view.hand.value;
    });
    expect(led).toEqual([2, 4, 0]);
  });

  it("gives both hands of somebody in the room hands that this page leads", () => {
    expect([false, true].map((isLeft) => handOfUser([0, 1], isLeft))).toEqual([0, 1]);
    expect([false, true].map((isLeft) => handOfUser([3, 4], isLeft))).toEqual([3, 4]);
    expect([false, true].map((isLeft) => handOfUser([2], isLeft))).toEqual([2, 2]);
    expect(handOfUser([], false)).toBeNull();
  });
});
