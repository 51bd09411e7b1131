// A whole session of a study in the program itself: a person by the mouse, from the consent to the tables.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import {
  browser,
  distance,
  fetchScene,
  findAndClickFace,
  makeFolder,
  nextFrame,
  poseOf,
  runProgram,
  shareBrowser,
  startStudio,
  takeByMouse,
  takePicture,
  turnView,
  waitForPicture,
  waitForRest,
  watchFor,
} from "./harness.mjs";
import { StudyPeer } from "./study_peer.mjs";
import { agree, openQuietPage, press, startTrial } from "./study_steps.mjs";

const kProtocol = `format: hvas-study-1
id: by-hand
title: {en: By the mouse}
product: bushing
part: shaft
participants: 1
languages: [en]
consent: {en: You may stop at any time.}
defaults: {fit: H7/g6, time_limit_s: 300}
conditions:
  - {id: picked, name: {en: Surfaces picked}, method: constraints_by_picking}
  - {id: hybrid, name: {en: Everything felt}, method: hybrid}
training: {minutes: 5, condition: hybrid}
blocks:
  - {id: timed, repetitions: 1, order: given}
questions:
  - {id: steady, kind: scale, text: "How steady was the force?", low: 1, high: 10}
hidden: [condition]
`;

shareBrowser();

/** The scene once a trial has put all other parts in their places, which its first tick does, and the part that is left. */
async function findTrialPart(page) {
  for (;;) {
    const scene = await fetchScene(page);
    const loose = scene.occurrences.map((o, k) => ({ ...o, occurrence: k })).filter(({ placement }) => placement === "loose");
    if (loose.length === 1) {
      return { scene, ...loose[0] };
    }
    await nextFrame(page);
  }
}

/** Drags a part in the plane of the screen until it looks as if it were at p_W, or until `isThere`. */
async function dragPart(page, occurrence, p_W, isThere = null) {
  const kTries = 60;
  const kThere = 2;  // [px]
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  for (let k = 0; k < kTries && !(await isThere?.()); k++) {
    const [from, to] = await page.evaluate(([o, p]) => [window.hvas.pose(o).p, p].map(window.hvas.project), [occurrence, p_W]);
    if (isThere === null && Math.hypot(to.x - from.x, to.y - from.y) < kThere) {
      break;
    }
    at.x += to.x - from.x;
    at.y += to.y - from.y;
    await page.mouse.move(at.x, at.y, { steps: 4 });
    await waitForRest(page, occurrence, { isOver: isThere });
  }
  await page.mouse.up();
}

/** Sets the constraints of a part one after the other, as they are listed. */
async function pickConstraints(person, scene, occurrence) {
  const mates = scene.mates.filter(({ b }) => b === occurrence);
  assert.equal(mates.length, 2);
  await person.getByText("Click a surface of the marked part.").waitFor();
  for (const [k, { a, b, faces_a: facesA, faces_b: facesB }] of mates.entries()) {
    await findAndClickFace(person, b, facesB[0], occurrence);
    await person.getByText("Now click the surface that it belongs to.").waitFor();
    await findAndClickFace(person, a, facesA[0], occurrence);
    await person.getByText(k === 0 ? "Constraints left: 1" : "Trial 2").first().waitFor();
  }
}

/** Turns the view to what is seen from straight above, or on to what is seen from the side. */
async function lookFromAbove(page) {
  await turnView(page, 0.6 * (await heightOf(page)));
}
async function lookFromTheSide(page) {
  await lookFromAbove(page);
  await turnView(page, -(await heightOf(page)) / 4);  // a turn is as long as the canvas is high
}

function heightOf(page) {
  return page.evaluate(() => document.querySelector("canvas").clientHeight);
}

/** Nothing helps to see how far away it is: it is lifted and pushed down seen from the side, and led over its place
 seen from above. */
async function insertPart(page, occurrence, goal) {
  const over = [goal[0], goal[1], goal[2] + 0.09];
  const isDone = async () => (await page.getByTestId("task").count()) === 0;
  await lookFromTheSide(page);
  const { p } = await poseOf(page, occurrence);
  await dragPart(page, occurrence, [p[0], p[1], over[2]]);
  await takePicture(page, "study_live_lifted");
  await lookFromAbove(page);
  await dragPart(page, occurrence, over);
  await takePicture(page, "study_live_over");
  await lookFromTheSide(page);
  await dragPart(page, occurrence, goal, isDone);
}

describe("a session with a person", () => {
  it("goes from the consent to the tables, by the mouse alone", async () => {
    const folder = makeFolder();
    const protocol = join(folder, "by_hand.yaml");
    const results = join(folder, "results");
    writeFileSync(protocol, kProtocol);
    const studio = await startStudio(["--study", protocol, "--participant", "P01", "-o", results]);
    const desk = new StudyPeer(studio.operator);
    try {
      const { page: person, complaints } = await openQuietPage(browser, studio.participant);
      await person.getByTestId("page-waiting").waitFor();
      await desk.until((state) => state.is_open);
      await desk.do("begin");
      await agree(person);

      await press(person, "study-ready");
      await waitForPicture(person);
      const { scene, occurrence, goal } = await findTrialPart(person);
      const before = await poseOf(person, occurrence);
      await takeByMouse(person, occurrence);
      await person.mouse.move(700, 400, { steps: 10 });
      assert.ok(distance(before, await waitForRest(person, occurrence)) > 0.03, "the part follows the mouse");
      await takePicture(person, "study_live_training");
      await person.mouse.up();
      await desk.do("next");

      await startTrial(person);
      await pickConstraints(person, scene, occurrence);
      await person.getByRole("heading", { name: "Trial 2" }).waitFor();
      await startTrial(person);
      const isMating = await watchFor(person, '[data-testid="task-hint"][data-state="mating"]');
      await insertPart(person, occurrence, goal.p);
      assert.ok(await isMating(), "the page says that the part is half in");

      await person.getByTestId("answer-8").check();
      await press(person, "answer-send");
      await person.getByTestId("page-done").waitFor();
      assert.deepEqual(complaints, []);
      await person.context().close();
      const { done } = await desk.until((state) => state.phase === "done");
      assert.deepEqual(done.map(({ condition, outcome }) => [condition, outcome]), [["picked", "done"], ["hybrid", "done"]]);
      assert.ok(done.every(({ time_s: time }) => time > 1 && time < 300));
      assert.ok(done[1].peak_force_n > 0, "its weight, at the least");
    } finally {
      await desk.leave();
      assert.equal(await studio.stop(), 0, "it ends well when it is told to");
    }

    const table = join(folder, "trials.csv");
    runProgram(["study", "export", results, "-o", table]);
    const rows = readFileSync(table, "utf8").trim().split("\n").filter((line) => !line.startsWith("#"));
    assert.equal(rows.length, 3, "a heading and two trials");
    assert.match(runProgram(["replay", join(results, "records/P01/002.hvasrec"), "--verify"]), /bit for bit/);
  });
});
