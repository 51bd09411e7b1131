// The first minute of a new user: from the address to the first part in its place, by mouse (docs/studio.md).
import assert from "node:assert/strict";
import { it } from "node:test";
import { browser, fetchScene, insertByMouse, makeFolder, openPage, shareBrowser, takePicture, waitForPicture, waitForPlacement, waitForState, withStudio, withStudios } from "./harness.mjs";

shareBrowser();

it("the start page offers examples and devices, and the first part is in its place within a minute of the session", withStudio(["--fresh"], async (studio) => {
  const { page } = await openPage(browser, studio.operator);
  await page.getByTestId("example-bushing").waitFor();
  await page.getByTestId("start-devices").waitFor();
  assert.equal(await page.getByTestId("start-demo").count(), 1);
  await page.getByTestId("drop-zone").waitFor();
  await takePicture(page, "start_page");
  await page.getByTestId("example-bushing").click();
  await waitForState(page, ({ hasScene }) => hasScene);
  await waitForPicture(page);
  const scene = await fetchScene(page);
  const first = scene.steps.find(({ kind }) => kind === "insert").occurrence;
  const { goal } = scene.occurrences.find(({ id }) => id === first);
  await insertByMouse(page, first, goal.p);
  await waitForPlacement(page, first, "placed");
  const ms = await page.evaluate(() => window.hvas.sessionMs);
  assert.ok(ms < 60_000, `${ms} ms`);
}));

it("a file that was opened before is offered again, to those who may open files only", withStudios(async (start) => {
  const home = makeFolder();
  const before = await start(["../products/peg_hole.step"], { home });
  const { page: old } = await openPage(browser, before.operator);
  await waitForPicture(old);
  await old.context().close();
  assert.equal(await before.stop(), 0);
  const studio = await start(["--fresh"], { home });
  const { page } = await openPage(browser, studio.operator);
  const offered = page.locator('[data-testid^="example-recent"]');
  await offered.waitFor();
  assert.match(await offered.innerText(), /peg_hole\.step/);
  const { page: viewer } = await openPage(browser, studio.viewer);
  await viewer.getByTestId("example-bushing").waitFor();
  assert.equal(await viewer.locator('[data-testid^="example-recent"]').count(), 0, "where the files lie is nobody else's business");
  await offered.click();
  await waitForState(page, ({ hasScene }) => hasScene);
}));
