// Tools and fixtures of the workshop are parts of the session, with contact (X16).
import assert from "node:assert/strict";
import { it } from "node:test";
import { browser, fetchScene, openPage, shareBrowser, stateOf, takeByMouse, takePicture, waitForPicture, withStudio } from "./harness.mjs";

shareBrowser();

it("X16: the workshop has tools and fixtures, and a hexagon key is taken by the mouse", withStudio(["../products/gear_pump.step", "--workshop"], async (studio) => {
  const { page, complaints } = await openPage(browser, studio.operator);
  await waitForPicture(page);
  const { occurrences } = await fetchScene(page);
  const names = occurrences.map(({ name }) => name);
  for (const name of ["hex_key_4", "hex_key_5", "hammer", "screwdriver", "spanner", "caliper", "vise", "chuck", "tray", "vblock"]) {
    assert.ok(names.includes(name), `${name} is on the bench`);
  }
  await takePicture(page, "workshop");
  const key = occurrences.find(({ name }) => name === "hex_key_5").id;
  await takeByMouse(page, key);
  assert.equal((await stateOf(page)).held[0].occurrence, key);
  await page.mouse.up();
  assert.deepEqual(complaints, []);
  await page.context().close();
}));
