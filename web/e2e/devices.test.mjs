// Two hands, and devices in them (N8 of the requirements, docs/studio.md).
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  openPage,
  shareBrowser,
  stateOf,
  takeByMouse,
  takePicture,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kBushingPart = 1;
const kShaft = 2;

shareBrowser();

async function openDevices(page) {
  await page.getByTestId("menu.simulate").click();
  await page.getByTestId("menu-devices").click();
  await page.getByTestId("hand-0").waitFor();
}

async function closeDialog(page) {
  await page.getByTestId("devices").getByRole("button", { name: "Close" }).click();
}

describe("the hands", () => {
  it("are two when asked for: each holds a part, and one waits while the other is led", withStudio([kBushing], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await openDevices(page);
    await page.getByTestId("hands-2").click();
    await page.getByTestId("hand-1").waitFor();
    await takePicture(page, "two_hands");
    await closeDialog(page);
    await waitForState(page, (state) => state.hands.length === 2);
    await takeByMouse(page, kShaft);
    await page.mouse.up();
    await page.keyboard.press("w");
    await takeByMouse(page, kBushingPart);
    await page.mouse.up();
    await waitForPlacement(page, kShaft, "held");
    const held = (await stateOf(page)).held;
    assert.deepEqual(held.map((each) => [each.hand, each.occurrence]), [[0, kShaft], [1, kBushingPart]]);
    const before = await page.evaluate((id) => window.hvas.pose(id), kShaft);
    await page.keyboard.press("PageUp");
    for (let k = 0; k < 20; k++) {
      await page.keyboard.press("ArrowUp");
    }
    await waitForRest(page, kBushingPart);
    const after = await page.evaluate((id) => window.hvas.pose(id), kShaft);
    assert.ok(Math.hypot(...after.p.map((v, k) => v - before.p[k])) < 1e-3, "the other hand stays where it is");
    await takePicture(page, "two_hands_hold");
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("go to other devices and back to the mouse; what cannot be is said with a remedy", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await openDevices(page);
    await page.getByTestId("search-devices").and(page.locator(":enabled")).waitFor();
    await page.locator(".emulated summary").click();
    const touch = page.locator(".emulated li").filter({ hasText: "Touch X" }).first();
    await touch.getByRole("button").first().click();
    await page.getByTestId("to-mouse-0").waitFor();
    assert.match(await page.getByTestId("hand-0").innerText(), /Touch X[\s\S]*emulated/);
    await takePicture(page, "device_in_hand");
    await page.getByTestId("to-mouse-0").click();
    await page.getByTestId("hand-0").filter({ hasText: "Mouse" }).waitFor();
    await closeDialog(page);
    await takeByMouse(page, kShaft);
    await page.mouse.up();
    await openDevices(page);
    await page.getByTestId("hands-2").click();
    await page.locator(".dialog-refusal").waitFor();
    assert.match(await page.locator(".dialog-refusal").innerText(), /release/i, "the part has to be released first");
    await takePicture(page, "device_refused");
    await page.context().close();
  }));
});
