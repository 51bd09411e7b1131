// A product of twelve parts in arbitrary poses goes together by the mates of its side file (X12).
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import {
  browser,
  fetchScene,
  openPage,
  poseOf,
  shareBrowser,
  takeByMouse,
  takePicture,
  waitForPicture,
  waitForPlacement,
  waitForState,
  waitForStill,
  withStudio,
} from "./harness.mjs";

const kLoose = "../products/loose_twelve.step";
const kTruth = JSON.parse(readFileSync("../products/loose_twelve.truth.json", "utf8")).assembled;
const kSamePlace = 1e-6;  // [m]

shareBrowser();

/** How far the origin of a part's goal is from where the truth has it [m]. */
function offOf(occurrence) {
  const truth = kTruth.find(({ occurrence: name }) => name === occurrence.name);
  return Math.hypot(...occurrence.goal.p.map((value, k) => value - truth.position_mm[k] / 1000));
}

/** Moves the mouse to where a point of W is seen. */
async function pointAt(page, p_W) {
  const to = await page.evaluate((p) => window.hvas.project(p), p_W);
  await page.mouse.move(to.x, to.y, { steps: 6 });
}

/** As insertByMouse(), but a part that turns slowly about its axis counts as at rest: most are round. */
async function insertRoundByMouse(page, occurrence, [x, y, z]) {
  const kOver = 0.12;
  await takeByMouse(page, occurrence);
  await pointAt(page, [x, y, z + kOver]);
  const whereabouts = async () => ({ p: (await poseOf(page, occurrence)).p });
  await waitForStill(page, whereabouts, { frames: 3, sessionMs: 120, most: 3e-4 });
  await pointAt(page, [x, y, z - 0.01]);
  await waitForState(page, ({ held, placements }) => held[0]?.state === "seated" || placements[occurrence] === "placed");
}

describe("twelve loose parts", () => {
  it("X12: go together by the mouse alone, where the mates say", withStudio([kLoose], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const scene = await fetchScene(page);
    assert.equal(scene.occurrences.length, 12);
    assert.deepEqual(scene.occurrences.filter((o) => offOf(o) > kSamePlace).map((o) => o.name), []);
    assert.deepEqual(scene.diagnostics.filter(({ severity }) => severity !== "note"), []);
    await takePicture(page, "loose_begin");
    const inserts = scene.steps.filter(({ kind }) => kind === "insert");
    assert.equal(inserts.length, 11);
    for (const step of inserts) {
      await insertRoundByMouse(page, step.occurrence, scene.occurrences[step.occurrence].goal.p);
      await page.mouse.up();
      await waitForPlacement(page, step.occurrence, "placed");
    }
    await takePicture(page, "loose_done");
    const { occurrences } = await fetchScene(page);
    assert.deepEqual(occurrences.filter((o) => o.placement !== "placed").map((o) => o.name), []);
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("X12: follow a mate that is removed and brought back", withStudio([kLoose], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const before = await fetchScene(page);
    const shaft = before.occurrences.find(({ name }) => name === "shaft");
    const bushing = before.occurrences.find(({ name }) => name === "bushing");
    const axis = before.mates.find((m) => m.kind === "axis_hole" && m.a === bushing.id && m.b === shaft.id);
    const plane = before.mates.find((m) => m.kind === "face_face" && [m.a, m.b].includes(bushing.id) && [m.a, m.b].includes(shaft.id));
    for (const key of [axis.key, plane.key]) {
      const { epoch, mates } = await fetchScene(page);
      await page.getByTestId(`part-${shaft.id}`).click();
      await page.getByTestId(`remove-mate-${mates.find((m) => m.key === key).id}`).click();
      await waitForState(page, (state) => state.hasScene && state.epoch > epoch);
    }
    const without = await fetchScene(page);
    assert.ok(offOf(without.occurrences[shaft.id]) > 0.05, "where it is drawn");
    await page.keyboard.press("Control+z");
    await waitForState(page, ({ epoch }) => epoch < without.epoch);
    await page.getByTestId("mate-freedom").first().waitFor();
    await page.keyboard.press("Control+z");
    await waitForState(page, ({ epoch }) => epoch === before.epoch);
    assert.ok(offOf((await fetchScene(page)).occurrences[shaft.id]) < kSamePlace, "where the mates say");
    await page.context().close();
  }));
});
