// What the studio does when the page that steers goes silent, and when one thinks better of opening a file.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import {
  distance,
  fetchScene,
  launchBrowser,
  openPage,
  poseOf,
  stateOf,
  takeByMouse,
  takePicture,
  waitForPicture,
  waitForPlacement,
  waitForState,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kShaft = 2;

let browser;
before(async () => {
  browser = await launchBrowser();
});
after(() => browser.close());

/** Holds the shaft over the table, with somebody who looks on. */
async function holdShaft(studio) {
  const { page } = await openPage(browser, studio.operator);
  await waitForPicture(page);
  const { page: viewer } = await openPage(browser, studio.viewer);
  await waitForPicture(viewer);
  await takeByMouse(page, kShaft);
  const at = await page.evaluate((id) => window.hvas.screen(id), kShaft);
  await page.mouse.move(at.x, at.y - 90, { steps: 10 });
  await page.waitForTimeout(1500);
  return { page, viewer };
}

/** The hand moves the part again. */
async function goesOn(page) {
  const before = await poseOf(page, kShaft);
  const at = await page.evaluate((id) => window.hvas.screen(id), kShaft);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x - 70, at.y, { steps: 10 });
  await page.waitForTimeout(1500);
  assert.ok(distance(await poseOf(page, kShaft), before) > 0.01, "it goes on from there");
  await page.mouse.up();
}

/** No force in the hand, the part where it was; the banner says why. */
async function findsForceTakenBack(viewer) {
  await viewer.getByTestId("safety").waitFor({ timeout: 10_000 });
  assert.match(await viewer.getByTestId("safety").textContent(), /client/i);
  const state = await waitForState(viewer, ({ hands }) => hands.length > 0 && Math.hypot(...hands[0].f_felt_W_n) < 1e-3);
  assert.equal(state.held[0]?.occurrence, kShaft, "the part stays in the hand");
  const still = await poseOf(viewer, kShaft);
  await viewer.waitForTimeout(700);
  assert.ok(distance(await poseOf(viewer, kShaft), still) < 1e-4, "and where it is");
}

describe("a page that steers", () => {
  it("stands still: the force goes, the part stays, and it goes on later", withStudio([kBushing], async (studio) => {
    const { page, viewer } = await holdShaft(studio);
    const stuck = page.evaluate(() => {
      const end = performance.now() + 6000;
      while (performance.now() < end) {
        // As a page that is busy with something else.
      }
    });
    await findsForceTakenBack(viewer);
    await takePicture(viewer, "fault_stuck_viewer");
    await stuck;
    await page.getByTestId("safety").waitFor();
    await takePicture(page, "fault_stuck_operator");
    await page.mouse.up();
    await goesOn(page);
    await waitForState(viewer, ({ safety }) => safety === null);
    await page.context().close();
    await viewer.context().close();
  }));

  it("is out of sight: the same, and it goes on when it comes back", withStudio([kBushing], async (studio) => {
    const { page, viewer } = await holdShaft(studio);
    const hide = (isHidden) =>
      page.evaluate((hidden) => {
        Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
        document.dispatchEvent(new Event("visibilitychange"));
      }, isHidden);
    await hide(true);
    await findsForceTakenBack(viewer);
    await hide(false);
    await page.mouse.up();
    await goesOn(page);
    await page.context().close();
    await viewer.context().close();
  }));

  it("is loaded anew with a part in the hand: one goes on with it, or lets it go", withStudio([kBushing], async (studio) => {
    const { page, viewer } = await holdShaft(studio);
    await page.mouse.up();
    await page.reload();
    await waitForPicture(page);
    await waitForState(page, (state) => state.hasLease);  // nobody else wants it
    await waitForState(page, ({ held }) => held[0]?.occurrence === kShaft);
    await takePicture(page, "fault_reloaded");
    await goesOn(page);
    await page.keyboard.press("r");
    await waitForPlacement(page, kShaft, "loose");
    await page.context().close();
    await viewer.context().close();
  }));

  it("says that the connection is lost when the program ends", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await studio.stop();
    await waitForState(page, ({ link }) => link === "lost");
    await page.getByText(/connection is lost/i).first().waitFor();
    await takePicture(page, "fault_lost");
    await page.context().close();
  }));
});

describe("opening", () => {
  /** Bytes go slowly, so that there is time to think better of it. */
  async function slowDown(page, bytesPerSecond) {
    const client = await page.context().newCDPSession(page);
    await client.send("Network.enable");
    await client.send("Network.emulateNetworkConditions", {
      offline: false,
      latency: 0,
      downloadThroughput: -1,
      uploadThroughput: bytesPerSecond,
    });
  }

  it("is stopped while the file is being sent", withStudio([], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await page.getByTestId("drop-zone").waitFor();
    await slowDown(page, 200_000);
    const chooser = page.waitForEvent("filechooser");
    await page.getByTestId("drop-zone").click();
    await (await chooser).setFiles({ name: "large.step", mimeType: "model/step", buffer: Buffer.alloc(4_000_000, "x") });
    await page.getByTestId("loading").waitFor();
    await page.waitForTimeout(1000);
    await takePicture(page, "upload");
    await page.getByTestId("cancel-open").click();
    await page.getByTestId("loading").waitFor({ state: "detached" });
    assert.equal(await page.getByTestId("failure").count(), 0, "nothing is complained about");
    assert.equal(await page.evaluate(async () => (await fetch("/api/scene")).status), 404);
    await page.context().close();
  }));

  it("is stopped while the file is being read, and the product before it stays", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const { epoch } = await fetchScene(page);
    const chooser = page.waitForEvent("filechooser");
    await page.getByTestId("menu.file").click();
    await page.getByTestId("menu-open").click();
    await (await chooser).setFiles("../products/frame_500.step");
    await page.getByTestId("cancel-open").click({ timeout: 20_000 });
    await page.getByTestId("loading").waitFor({ state: "detached" });
    await page.waitForTimeout(3000);
    assert.equal((await fetchScene(page)).epoch, epoch);
    assert.equal((await stateOf(page)).hasScene, true);
    await takePicture(page, "open_cancelled");
    await page.context().close();
  }));
});
