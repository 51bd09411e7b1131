// A subassembly that is built on the table is a body: it is carried, put in and drawn out as one (X1).
import assert from "node:assert/strict";
import { it } from "node:test";
import {
  browser,
  distance,
  fetchScene,
  insertByMouse,
  openPage,
  poseOf,
  shareBrowser,
  stateOf,
  takePicture,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  withStudio,
} from "./harness.mjs";

const kPump = "../products/gear_pump.step";

shareBrowser();

/** Of two parts that stand as drawn (neither is turned): from the origin of the first to that of the second. */
function drawnOffset(scene, from, to) {
  return scene.occurrences[to].goal.p.map((v, k) => v - scene.occurrences[from].goal.p[k]);
}

it("X1 subassembly of the gear pump is built on the table, carried and inserted, by mouse", withStudio([kPump], async (studio) => {
  const { page, complaints } = await openPage(browser, studio.operator);
  await waitForPicture(page);
  const scene = await fetchScene(page);
  const find = (name) => scene.occurrences.find((o) => o.name === name).id;
  const [bushing, shaft] = [find("bushing 1"), find("drive gear shaft")];

  // On the table: the shaft is put into its bushing, which lies there as drawn.
  const lying = await poseOf(page, bushing);
  const offset = drawnOffset(scene, bushing, shaft);
  await insertByMouse(page, shaft, lying.p.map((v, k) => v + offset[k]), 0.12);
  await page.mouse.up();
  await waitForState(page, ({ leaders }) => leaders[shaft] === bushing && leaders[bushing] === bushing);
  await waitForPlacement(page, shaft, "loose");
  await takePicture(page, "x1_on_the_table");
  const together = { p: drawnOffset(scene, bushing, shaft) };
  const apart = async () => {
    const [a, b] = [await poseOf(page, bushing), await poseOf(page, shaft)];
    return distance({ p: b.p.map((v, k) => v - a.p[k]) }, together);
  };
  assert.ok((await apart()) < 1e-4, "the shaft is in the bushing");

  // A click on one of them selects and marks both.
  const at = await page.evaluate((id) => window.hvas.screen(id), bushing);
  await page.mouse.click(at.x, at.y);
  await waitForState(page, ({ selected }) => selected.includes(bushing) && selected.includes(shaft));

  // Taken by one of them, both are carried to the housing and put in.
  await insertByMouse(page, bushing, scene.occurrences[bushing].goal.p);
  await takePicture(page, "x1_inserting");
  await page.mouse.up();
  await waitForPlacement(page, bushing, "placed");
  await waitForPlacement(page, shaft, "placed");
  await waitForRest(page, shaft);
  for (const part of [bushing, shaft]) {
    assert.ok(distance(await poseOf(page, part), scene.occurrences[part].goal) < 1e-4, `part ${part} is in its place`);
  }
  assert.equal((await stateOf(page)).leaders[shaft], bushing, "they are still one");
  await takePicture(page, "x1_inserted");
  assert.deepEqual(complaints, []);
  await page.context().close();
}));
