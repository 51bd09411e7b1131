// A whole product put together by keys alone. What is read from the page is what a person sees there: where the part
// and its place are, and how far the keys move it on the screen.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  fetchScene,
  findBarriers,
  openPage,
  poseOf,
  pressTimes,
  shareBrowser,
  stateOf,
  tabToPicture,
  takePicture,
  waitForCalm,
  waitForPicture,
  waitForPlacement,
  waitForState,
  waitForStill,
  waitForView,
  withStudio,
} from "./harness.mjs";

shareBrowser();

const kStepPx = 6;  // of a key press
const kFine = 0.2;  // of it, with Alt

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const add = (a, b, factor = 1) => a.map((value, k) => value + factor * b[k]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The axes of the screen in W, right, up and away, and the metres of a key press, in parallel projection. */
async function lookAtAxes(page) {
  const kLength = 0.01;
  const points = [[0, 0, 0], [kLength, 0, 0], [0, kLength, 0], [0, 0, kLength]];
  const [o, ...ends] = await page.evaluate((all) => all.map((p) => window.hvas.project(p)), points);
  const rows = [ends.map((at) => (at.x - o.x) / kLength), ends.map((at) => (o.y - at.y) / kLength)];
  const pixelsPerMetre = Math.hypot(...rows[0]);
  const [right, up] = rows.map((row) => row.map((value) => value / pixelsPerMetre));
  return { right, up, away: cross(up, right), step: kStepPx / pixelsPerMetre };
}

/** Presses the keys that move the part in the hand by a vector of W [m], in the view as it is now.
 @returns the metres of a key press. */
async function pressMove(page, move) {
  await waitForView(page);  // It goes by itself to the part whose turn it is.
  const axes = await lookAtAxes(page);
  for (const [axis, more, less] of [["up", "ArrowUp", "ArrowDown"], ["right", "ArrowRight", "ArrowLeft"], ["away", "PageUp", "PageDown"]]) {
    const fine = Math.round(dot(move, axes[axis]) / (kFine * axes.step));
    const key = fine > 0 ? more : less;
    await pressTimes(page, key, Math.floor(Math.abs(fine) * kFine));
    await pressTimes(page, `Alt+${key}`, Math.abs(fine) % (1 / kFine));
  }
  return axes.step;
}

/** Takes the part whose turn it is, lifts it, brings it before its place, and pushes it in until it sits. */
async function insertByKeys(page, step, goal) {
  const kLift = 0.1;
  const kBefore = 0.05;
  const kOn = 0.01;
  const kTries = 30;
  const isOver = async () => {
    const { placements, held } = await stateOf(page);
    return placements[step.occurrence] === "placed" || held[0]?.state === "seated";
  };
  // It may go on turning slowly about its axis: that is not waited for.
  const whereabouts = async () => ({ p: (await poseOf(page, step.occurrence)).p });
  const rest = () => waitForStill(page, whereabouts, { frames: 3, sessionMs: 120, most: 3e-4, isOver });
  const goTo = async (target, presses) => {
    let within = 0;
    for (let count = 0; count < 6 && !(await isOver()); count++) {
      const missing = add(target, (await poseOf(page, step.occurrence)).p, -1);
      if (Math.hypot(...missing) < within) {
        return;
      }
      within = presses * (await pressMove(page, missing));
      await rest();
    }
  };
  await page.keyboard.press("Enter");
  await waitForPlacement(page, step.occurrence, "held");
  await rest();
  const before = add(goal, step.way_in, -Math.max(kBefore, step.distance_m + kOn));
  const height = Math.max(before[2], (await poseOf(page, step.occurrence)).p[2]) + kLift;
  await goTo([...(await poseOf(page, step.occurrence)).p.slice(0, 2), height], 5);
  await goTo([before[0], before[1], height], 5);
  await goTo(before, kFine);
  for (let count = 0; count < kTries && !(await isOver()); count++) {
    await pressMove(page, step.way_in.map((value) => kOn * value));
    await rest();
  }
  // What has been let go is told of by a frame, and that it is placed by an event a little later.
  await waitForPlacement(page, step.occurrence, "placed");
}

describe("the whole gear pump", () => {
  it("is put together by keys alone", withStudio(["../products/gear_pump.step"], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const scene = await fetchScene(page);
    await tabToPicture(page);
    await page.keyboard.press("p");
    await waitForCalm(page);
    assert.deepEqual(await findBarriers(page), []);
    await takePicture(page, "keys_begin");
    for (const step of scene.steps.filter(({ kind }) => kind === "insert")) {
      await waitForState(page, ({ step: { index } }) => scene.steps[index] === step);
      await insertByKeys(page, step, scene.occurrences[step.occurrence].goal.p);
    }
    await takePicture(page, "keys_done");
    const { occurrences } = await fetchScene(page);
    assert.deepEqual(occurrences.filter((o) => o.placement !== "placed").map((o) => o.name), []);
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));
});
