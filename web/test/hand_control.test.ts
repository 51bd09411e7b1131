import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Studio } from "../src/model/studio";
import { makeStore } from "../src/model/store";
import { makeViewState } from "../src/model/view_state";
import type { HandInput } from "../src/protocol/frames";
import type { HandSetup, TakeReply } from "../src/protocol/messages";
import { HandControl } from "../src/view3d/hand_control";
import type { Eye } from "../src/view3d/mouse_hand";
import type { SceneView } from "../src/view3d/scene_view";
import { toyScene } from "./toy_recording";

const eye: Eye = {
  right: [1, 0, 0],
  up: [0, 0, 1],
  back: [0, -1, 0],
  rayTo: (p) => ({ from: [p[0], p[1] - 1, p[2]], along: [0, 1, 0] }),
  metresPerPixel: () => 1e-3,
};

function setup(hand: number, index = 0, isEmulated = false): HandSetup {
  const device = { index, name: `device ${index}`, model: "", serial: "", is_emulated: isEmulated, has_force: true, has_torque: true };
  return { hand, device: { ...device, max_force_n: 8, scale: 1, notes: [] }, condition: "ready", lease: null };
}

function takeReply(occurrence: number): TakeReply {
  return { hand: toyScene.occurrences[occurrence]!.start, occurrence, members: [], way_in: [0, 0, -1], table_places: [] };
}

/** A page with two hands, of which the server has been told what is listed. */
function makePage() {
  const store = makeStore();
  store.link.value = "open";
  store.client.value = "c1";
  store.hasLease.value = true;
  store.clients.value = [{ id: "c1", name: "", role: "operator", has_lease: true, hands: [0, 1] }];
  store.hands.value = [setup(0), setup(1)];
  store.live.scene.value = toyScene;
  const commands: unknown[] = [];
  const inputs: (readonly HandInput[])[] = [];
  const studio = {
    store,
    command: async (command: { command: string; occurrence?: number }) => {
      commands.push(command);
      return command.command === "take" ? takeReply(command.occurrence!) : {};
    },
    sendInput: (sent: readonly HandInput[]) => inputs.push(sent),
    rest: vi.fn(),
  };
  const product = {
    scene: toyScene,
    occurrence: (id: number) => toyScene.occurrences[id] ?? null,
    poseOf: () => null,
    parts: null,
    clearance: () => 0.05,
  };
  const view = makeViewState();
  const control = new HandControl(studio as unknown as Studio, product as unknown as SceneView, view);
  return { store, view, control, commands, inputs, rest: studio.rest };
}

describe("the mouse with two hands", () => {
  beforeEach(() => vi.stubGlobal("document", { hidden: false }));
  afterEach(() => vi.unstubAllGlobals());

  it("leads one, and the other one stays where it was led to", async () => {
    const { view, control, commands, inputs } = makePage();
    expect(await control.take(1)).toBe(true);
    control.mouse.nudge(0.02, 0, 0, eye);
    for (let k = 0; k < 100; k++) {
      control.update(0.02, null, eye);
    }
    const left = inputs.at(-1)![0]!;
    view.hand.value = 1;
    expect(control.canTake(2)).toBe(true);
    expect(await control.take(2)).toBe(true);
    control.mouse.nudge(0, 0.03, 0, eye);
    for (let k = 0; k < 100; k++) {
      control.update(0.02, null, eye);
    }
    const [first, second] = inputs.at(-1)!;
    expect([first!.hand, second!.hand]).toEqual([0, 1]);
    first!.p_WH_m.forEach((v, k) => expect(v).toBeCloseTo(left.p_WH_m[k]!, 4));
    expect(second!.p_WH_m[2]).toBeGreaterThan(0.01);
    expect(commands).toMatchObject([
      { command: "take", hand: 0, occurrence: 1 },
      { command: "take", hand: 1, occurrence: 2 },
    ]);
  });

  it("lets go with the one that it leads, and goes on telling of the other", async () => {
    const { view, control, commands, inputs, rest } = makePage();
    await control.take(1);
    view.hand.value = 1;
    await control.take(2);
    control.release();
    expect(commands.at(-1)).toEqual({ command: "release", hand: 1 });
    expect(rest).not.toHaveBeenCalled();
    control.update(0.02, null, eye);
    expect(inputs.at(-1)!.map((input) => input.hand)).toEqual([0]);
    control.turnTo(1);
    expect(view.hand.value).toBe(0);
    control.releaseAll();
    expect(commands.at(-1)).toEqual({ command: "release", hand: 0 });
    expect(rest).toHaveBeenCalledOnce();
  });

  it("forgets a hand that was handed over, and leads none with a real device in it", async () => {
    const { store, view, control } = makePage();
    await control.take(1);
    store.clients.value = [{ id: "c1", name: "", role: "operator", has_lease: false, hands: [1] }];
    expect(control.isBusy).toBe(false);
    expect(view.hand.value, "the one that it still leads").toBe(1);
    expect(control.canTake(2)).toBe(true);
    store.hands.value = [setup(0), setup(1, 3)];
    expect(control.canTake(2)).toBe(false);
    store.hands.value = [setup(0), setup(1, 9, true)];
    expect(control.canTake(2)).toBe(true);
    store.hands.value = [setup(0)];
    expect(view.hand.value, "there is no second hand any more").toBe(0);
  });

  it("takes nothing while a recording is looked at", () => {
    const { store, control } = makePage();
    expect(control.canTake(1)).toBe(true);
    store.replay.value = store.live;
    expect(control.canTake(1)).toBe(false);
  });
});
