// Two people put the cover of the gear pump on together, and eight look on (docs/studio.md).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { it } from "node:test";
import {
  bringInByMouse,
  browser,
  connect,
  distance,
  fetchScene,
  kProgram,
  makeFolder,
  openPage,
  shareBrowser,
  signIn,
  stateOf,
  takeByMouse,
  takeOverByMouse,
  takePicture,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  withStudios,
} from "./harness.mjs";

shareBrowser();

/** The simulated person does the steps before that of a part. */
async function doStepsBefore(page, scene, part) {
  const wanted = scene.steps.findIndex(({ occurrence, kind }) => occurrence === part && kind === "insert");
  for (let index = (await stateOf(page)).step.index; index < wanted; index++) {
    await page.keyboard.press("n");
    await waitForState(page, ({ step, demo }) => step.index > index && !demo);
  }
}

it("two people put the cover on together, handing it over, and eight look on", withStudios(async (start) => {
  const home = makeFolder();
  const studio = await start(["../products/gear_pump.step"], { home });
  const { page: first } = await openPage(browser, studio.operator);
  await waitForPicture(first);
  const scene = await fetchScene(first);
  const cover = scene.occurrences.find(({ name }) => name === "cover");
  await first.evaluate(() => document.activeElement?.blur());
  await doStepsBefore(first, scene, cover.id);

  const { page: second } = await openPage(browser, studio.operator);
  await waitForPicture(second);
  await second.getByTestId("hint-join").click();
  await first.getByTestId("lease-asked").getByRole("button", { name: "Give" }).click();
  await waitForState(first, ({ hands }) => hands.length === 2);
  await first.getByTestId("rec").click();
  await waitForState(first, ({ recording }) => recording !== null);

  // One of them is a page, and a small one; eight that draw by software would take the two cores from each other.
  const { page: onlooker } = await openPage(browser, studio.viewer, { viewport: { width: 480, height: 300 } });
  await waitForPicture(onlooker);
  const session = await signIn(studio.viewer);
  const others = await Promise.all(Array.from({ length: 7 }, () => connect(session)));

  await takeByMouse(first, cover.id);
  await first.mouse.up();
  const before = await waitForRest(first, cover.id);
  await second.getByTestId("ask-part").click();
  await takePicture(second, "two_people_asks");
  await first.getByTestId("part-asked").getByRole("button", { name: "Hand over" }).click();
  await waitForState(second, ({ held }) => held.length === 1 && held[0].hand === 1);
  const handed = await waitForRest(second, cover.id);
  assert.ok(distance(handed, before) < 0.01, `it has fallen by ${distance(handed, before)} m`);

  await takeOverByMouse(second, cover.id);
  await bringInByMouse(second, cover.id, cover.goal.p);
  await waitForPlacement(second, cover.id, "placed");
  await second.mouse.up();
  await takePicture(first, "two_people_cover");
  const led = await waitForRest(first, cover.id);
  assert.ok(distance(await waitForRest(onlooker, cover.id), led) < 1e-3, "whoever looks on sees it there");
  await Promise.all(others.map(({ find }) => find((event) => event.placement === "placed" && event.occurrence === cover.id)));

  await first.getByTestId("rec").click();
  await waitForState(first, ({ recording }) => recording === null);
  await first.getByTestId("open-last").waitFor();
  assert.equal(await studio.stop(), 0);
  const [record] = readdirSync(home, { recursive: true }).filter((name) => name.endsWith(".hvasrec"));
  const replay = JSON.parse(execFileSync(kProgram, ["replay", join(home, record), "--json"], { encoding: "utf8" }));
  assert.equal(replay.exact, true, JSON.stringify(replay));
}));
