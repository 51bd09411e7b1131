// VR with an emulated headset: the page knows nothing of it. (X9, X16, N2)
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import {
  browser,
  distance,
  fetchScene,
  kSilentMs,
  openPage,
  passSession,
  poseOf,
  shareBrowser,
  takePicture,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  waitForView,
  withStudio,
} from "./harness.mjs";
import { compose, inverse, multiply, rotate } from "./poses.mjs";

const kBushing = "../products/bushing.step";
const [kSleeve, kShaft] = [1, 2];

shareBrowser();

/** In the page, before anything else: a headset on a head at 1.6 m, and a book of what vibrates. */
function installHeadset() {
  const device = new window.IWER.XRDevice(window.IWER.metaQuest3);
  device.installRuntime({ forceInstall: true });
  device.stereoEnabled = true;
  device.position.set(0, 1.6, 0);
  window.headset = device;
  window.pulses = [];
  const proto = window.IWER.GamepadHapticActuator?.prototype ?? window.GamepadHapticActuator?.prototype;
  const note = (actuator) => {
    const pulse = actuator.pulse;
    actuator.pulse = function record(strength, ms) {
      window.pulses.push({ strength, ms });
      return pulse.call(this, strength, ms);
    };
  };
  if (proto?.pulse) {
    note(proto);
  } else {
    for (const controller of Object.values(device.controllers)) {
      controller.inputSource.gamepad.hapticActuators.forEach(note);
    }
  }
}

async function openVr(link) {
  const { page, complaints } = await openPage(browser, link, { beforeLoad: async (fresh) => {
    await fresh.addInitScript({ content: readFileSync("node_modules/iwer/build/iwer.min.js", "utf8") });
    await fresh.addInitScript(installHeadset);
  } });
  await waitForPicture(page);
  return { page, complaints };
}

async function enter(page) {
  await page.getByTestId("enter-vr").click();
  await waitForState(page, (state) => state.isInVr);
  await frames(page, 4);
}

/** Until so many pictures have been drawn: an emulated headset is slow without a graphics processor. */
async function frames(page, count) {
  const from = await page.evaluate(() => window.hvas.framesDrawn);
  await page.waitForFunction((to) => window.hvas.framesDrawn >= to, from + count);
}

const hands = (page) => page.evaluate(() => window.hvas.room.hands());
const partAt = (page, id) => page.evaluate((o) => window.hvas.room.part(o), id);

/** Puts one of the emulated inputs so that the point with which it takes hold is at a pose of the room. */
class Lead {
  constructor(page, index, input) {
    Object.assign(this, { page, index, input });
  }

  async set({ p, q }) {
    await this.page.evaluate(([path, at, turn]) => {
      const input = path.reduce((object, key) => object[key], window.headset);
      input.position.set(...at);
      input.quaternion.set(turn[1], turn[2], turn[3], turn[0]);
    }, [this.input, p, q]);
  }

  /** Measures where it takes hold, seen from where the emulator has it. */
  async calibrate(p) {
    const set = { p, q: [1, 0, 0, 0] };
    await this.set(set);
    await frames(this.page, 3);
    const hand = (await hands(this.page))[this.index];
    this.X_DC = compose(inverse(set), { p: hand.p, q: hand.q });
  }

  async moveTo(X_RC, count = 2) {
    await this.set(compose(X_RC, inverse(this.X_DC)));
    await frames(this.page, count);
  }

  async pose() {
    const { p, q } = (await hands(this.page))[this.index];
    return { p, q };
  }
}

const trigger = (page, side, value) =>
  page.evaluate(([s, v]) => window.headset.controllers[s].updateButtonValue("trigger", v), [side, value]);
const squeeze = (page, side, value) =>
  page.evaluate(([s, v]) => window.headset.controllers[s].updateButtonValue("squeeze", v), [side, value]);

/** The controller of the right hand, at the middle of a part, with the trigger pressed. */
async function grabPart(page, occurrence) {
  const lead = new Lead(page, await indexOf(page, "right"), ["controllers", "right"]);
  await lead.calibrate([0.3, 1.2, -0.3]);
  await lead.moveTo({ p: await partAt(page, occurrence), q: [1, 0, 0, 0] }, 4);
  await trigger(page, "right", 1);
  await waitForPlacement(page, occurrence, "held");
  await waitForState(page, ({ held }) => held.length === 1);
  return lead;
}

async function indexOf(page, side) {
  return page.evaluate((s) => [...window.headset.activeInputs ?? []].findIndex((i) => i.inputSource.handedness === s), side);
}

describe("somebody in VR", () => {
  it("takes the shaft with a controller, puts it into the bushing, and feels it", withStudio([kBushing], async (studio) => {
    const { page, complaints } = await openVr(studio.operator);
    const scene = await fetchScene(page);
    await page.keyboard.press("n");  // the bushing first: by the simulated person
    await waitForPlacement(page, kSleeve, "placed");
    await waitForState(page, ({ demo }) => !demo);
    await enter(page);
    await takePicture(page, "vr_entered");

    const lead = await grabPart(page, kShaft);
    await takePicture(page, "vr_grabbed");
    const pulsesAtGrab = await page.evaluate(() => window.pulses.length);
    assert.ok(pulsesAtGrab >= 1, "the grab is felt");

    const world = await page.evaluate(() => window.hvas.room.world());
    const { start, goal, p_BoBcm_m } = await occurrenceNow(page, scene, kShaft);
    const toRoom = ({ p, q }) => ({
      p: rotate(world.q, p).map((v, k) => world.p[k] + world.scale * v),
      q: multiply(world.q, q),
    });
    const centreOf = (pose) => rotate(pose.q, p_BoBcm_m).map((v, k) => pose.p[k] + v);
    const turn = multiply(goal.q, inverse({ p: [0, 0, 0], q: start.q }).q);
    // Of the server's hand, which is upright in W when it takes hold.
    const X_RH0 = toRoom({ p: centreOf(start), q: [1, 0, 0, 0] });
    const X_CH = compose(inverse(await lead.pose()), X_RH0);
    const handAbove = (height) => {
      const at = centreOf(goal);
      return toRoom({ p: [at[0], at[1], at[2] + height], q: turn });
    };
    const above = 0.11;
    const up = toRoom({ p: centreOf(start).map((v, k) => (k === 2 ? v + above : v)), q: turn });
    for (const hand of [up, handAbove(above)]) {
      await lead.moveTo(compose(hand, inverse(X_CH)), 12);
    }
    for (let height = above; height > -0.012; height -= 0.006) {
      await lead.moveTo(compose(handAbove(height), inverse(X_CH)), 2);
      if (height < 0.05 && height > 0.043) {
        await takePicture(page, "vr_inserting");
      }
    }
    await waitForState(page, ({ held }) => held[0]?.state === "seated");
    await takePicture(page, "vr_seated");
    const pulses = await page.evaluate(() => window.pulses);
    assert.ok(pulses.some((p) => p.ms === 60), "capture is felt");
    assert.ok(pulses.some((p) => p.strength === 1 && p.ms === 90), "the seat is felt");
    assert.ok(pulses.filter((p) => p.ms === 40 && p.strength < 0.8).length > 3, "and so is the push");
    await trigger(page, "right", 0);
    await waitForPlacement(page, kShaft, "placed");
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("loses a controller with a part in it, and goes on when it is back", withStudio([kBushing], async (studio) => {
    const { page } = await openVr(studio.operator);
    await enter(page);
    const lead = await grabPart(page, kShaft);
    const away = await lead.pose();
    await lead.moveTo({ ...away, p: [away.p[0], away.p[1] + 0.1, away.p[2]] });
    await waitForRest(page, kShaft);
    await page.evaluate(() => (window.headset.controllers.right.connected = false));
    await waitForState(page, ({ safety }) => safety !== null);
    const left = await poseOf(page, kShaft);
    await waitForPlacement(page, kShaft, "held");
    await takePicture(page, "vr_lost");
    // It comes back somewhere else, without its button: the part does not leap.
    await lead.set({ p: [0.5, 1.4, -0.2], q: [1, 0, 0, 0] });
    await trigger(page, "right", 0);
    await page.evaluate(() => (window.headset.controllers.right.connected = true));
    await frames(page, 8);
    await passSession(page, 2 * kSilentMs);
    assert.ok(distance(await poseOf(page, kShaft), left) < 0.005, "no leap");
    await trigger(page, "right", 1);
    await frames(page, 3);
    const from = await lead.pose();
    await lead.moveTo({ ...from, p: [from.p[0] - 0.15, from.p[1], from.p[2]] });
    assert.ok(distance(await waitForRest(page, kShaft), left) > 0.02, "it goes on");
    await trigger(page, "right", 0);
    await waitForPlacement(page, kShaft, "loose");
    await page.context().close();
  }));

  it("takes it with a bare hand as well", withStudio([kBushing], async (studio) => {
    const { page } = await openVr(studio.operator);
    await enter(page);
    await page.evaluate(() => (window.headset.primaryInputMode = "hand"));
    await frames(page, 6);
    const lead = new Lead(page, await indexOf(page, "right"), ["hands", "right"]);
    const pinch = (value) => page.evaluate((v) => window.headset.hands.right.updatePinchValue(v), value);
    await pinch(0.8);  // half closed: the tips are where they will be
    await lead.calibrate([0.3, 1.2, -0.3]);
    await pinch(0);
    await lead.moveTo({ p: await partAt(page, kShaft), q: (await lead.pose()).q }, 4);
    await pinch(1);
    await waitForPlacement(page, kShaft, "held");
    await takePicture(page, "vr_hand");
    await pinch(0);
    await waitForPlacement(page, kShaft, "loose");
    await page.context().close();
  }));

  it("turns and scales the world, presses panels and leaves", withStudio([kBushing], async (studio) => {
    const { page } = await openVr(studio.operator);
    const eye = await page.evaluate(() => location.href && window.hvas.project([0, 0, 0]));
    await enter(page);
    const world = () => page.evaluate(() => window.hvas.room.world());
    const first = await world();
    await page.evaluate(() => window.headset.controllers.right.updateAxes("thumbstick", 1, 0));
    await frames(page, 4);
    await page.evaluate(() => window.headset.controllers.right.updateAxes("thumbstick", 0, 0));
    await frames(page, 4);
    const turned = await world();
    const angle = 2 * Math.acos(Math.min(1, Math.abs(turned.q.reduce((n, v, k) => n + v * first.q[k], 0))));
    assert.ok(Math.abs(angle - Math.PI / 6) < 1e-3, `30 degrees a push, and only one: ${angle}`);

    const [left, right] = [
      new Lead(page, await indexOf(page, "left"), ["controllers", "left"]),
      new Lead(page, await indexOf(page, "right"), ["controllers", "right"]),
    ];
    await left.calibrate([-0.2, 1.9, -0.4]);
    await right.calibrate([0.2, 1.9, -0.4]);
    await squeeze(page, "left", 1);
    await squeeze(page, "right", 1);
    await frames(page, 3);
    await left.moveTo({ p: [-0.4, 1.9, -0.4], q: [1, 0, 0, 0] });
    await right.moveTo({ p: [0.4, 1.9, -0.4], q: [1, 0, 0, 0] }, 4);
    await squeeze(page, "left", 0);
    await squeeze(page, "right", 0);
    await frames(page, 3);
    const ratio = (await world()).scale / turned.scale;
    assert.ok(ratio > 1.5 && ratio < 2.6, `hands twice as far apart: twice as large: ${ratio}`);
    await takePicture(page, "vr_scaled");

    await press(page, right, "before");
    assert.ok(Math.abs((await world()).scale - first.scale) < 1e-6, "as at first");
    await press(page, right, "seated");
    assert.ok((await world()).p[1] !== first.p[1]);
    await takePicture(page, "vr_seated_mode");
    await left.moveTo({ p: [-0.25, 1.25, -0.35], q: [1, 0, 0, 0] });
    await press(page, right, "forces");
    await waitForState(page, ({ forcesOff }) => forcesOff);
    await takePicture(page, "vr_forces_off");
    await press(page, right, "leave");
    await waitForState(page, ({ isInVr }) => !isInVr);
    await waitForView(page);
    const after = await page.evaluate(() => window.hvas.project([0, 0, 0]));
    assert.ok(Math.hypot(after.x - eye.x, after.y - eye.y) < 2, "the picture on the desk is as it was");
    await takePicture(page, "vr_left");
    await page.context().close();
  }));
});

/** Points at a button from half a metre before it, and presses the trigger. */
async function press(page, lead, id) {
  const at = await page.evaluate((name) => window.hvas.room.button(name), id);
  assert.ok(at, `there is a button ${id}`);
  const from = [at[0] * 0.6, 1.6 + (at[1] - 1.6) * 0.6, at[2] * 0.6];
  const along = at.map((v, k) => v - from[k]);
  const length = Math.hypot(...along);
  const yaw = Math.atan2(-along[0], -along[2]);
  const pitch = Math.asin(along[1] / length);
  const q = multiply([Math.cos(yaw / 2), 0, Math.sin(yaw / 2), 0], [Math.cos(pitch / 2), Math.sin(pitch / 2), 0, 0]);
  await lead.set({ p: from, q });
  await frames(page, 3);
  await trigger(page, "right", 1);
  await frames(page, 2);
  await trigger(page, "right", 0);
  await frames(page, 3);
}

async function occurrenceNow(page, scene, id) {
  const part = scene.occurrences[id];
  return { ...part, start: await poseOf(page, id) };
}
