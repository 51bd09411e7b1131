// What the studio does when the page that steers goes silent, and when one thinks better of opening a file.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import {
  browser,
  distance,
  fetchScene,
  kSilentMs,
  openPage,
  passSession,
  poseOf,
  shareBrowser,
  shareStudio,
  stateOf,
  takePicture,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  waitForView,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kShaft = 2;

shareBrowser();

/** The mouse takes hold of the shaft, which may be in the hand already, and holds it higher. */
async function liftShaft(page) {
  await waitForView(page); // It is pressed where it is seen when the button goes down.
  const at = await page.evaluate((id) => window.hvas.screen(id), kShaft);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x, at.y - 70, { steps: 4 });
  await waitForPlacement(page, kShaft, "held");
  await waitForRest(page, kShaft);
}

/** The hand moves the part again. */
async function goesOn(page) {
  const before = await poseOf(page, kShaft);
  await waitForView(page); // It is pressed where it is seen when the button goes down.
  const at = await page.evaluate((id) => window.hvas.screen(id), kShaft);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x - 70, at.y, { steps: 4 });
  assert.ok(distance(await waitForRest(page, kShaft), before) > 0.01, "it goes on from there");
  await page.mouse.up();
}

/** The page's main thread stands still until it is told to go on, as where it is busy with something else; its worker
 does not. */
async function freeze(page) {
  const client = await page.context().newCDPSession(page);
  await client.send("Debugger.enable");
  const paused = new Promise((resolve) => client.once("Debugger.paused", resolve));
  await client.send("Debugger.pause");
  await paused;
  return async () => {
    await client.send("Debugger.resume");
    await client.detach();
  };
}

/** No force in the hand, the part where it was; the banner says why. */
async function findsForceTakenBack(viewer) {
  await viewer.getByTestId("safety").waitFor();
  assert.match(await viewer.getByTestId("safety").textContent(), /client/i);
  const state = await waitForState(viewer, ({ hands }) => hands.length > 0 && Math.hypot(...hands[0].f_felt_W_n) < 1e-3);
  assert.equal(state.held[0]?.occurrence, kShaft, "the part stays in the hand");
  const still = await poseOf(viewer, kShaft);
  await passSession(viewer, 2 * kSilentMs);
  assert.ok(distance(await poseOf(viewer, kShaft), still) < 1e-4, "and where it is");
}

describe("a page that steers", () => {
  const studio = shareStudio([kBushing]);
  let page;
  let viewer;  // somebody who looks on
  before(async () => {
    ({ page } = await openPage(browser, studio.operator));
    ({ page: viewer } = await openPage(browser, studio.viewer));
    await waitForPicture(page);
    await waitForPicture(viewer);
  });
  after(async () => {
    await page.context().close();
    await viewer.context().close();
  });

  it("stands still: the force goes, the part stays, and it goes on later", async () => {
    await liftShaft(page);
    const goOn = await freeze(page);
    await findsForceTakenBack(viewer);
    await takePicture(viewer, "fault_stuck_viewer");
    await goOn();
    await page.getByTestId("safety").waitFor();
    await takePicture(page, "fault_stuck_operator");
    await page.mouse.up();
    await goesOn(page);
    await waitForState(viewer, ({ safety }) => safety === null);
  });

  it("is out of sight: the same, and it goes on when it comes back", async () => {
    await liftShaft(page);
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
  });

  it("says what is the matter above every panel", async () => {
    await page.evaluate(() => document.activeElement?.blur());
    for (const key of ["x", "u"]) {  // section, workshop
      await page.keyboard.press(key);
    }
    await page.getByTestId("bench-panel").waitFor();
    await page.getByTestId("forces-off").click();
    const banner = page.getByTestId("forces-are-off");
    await banner.waitFor();
    await takePicture(page, "fault_above_panels");
    const isOnTop = await banner.evaluate((element) => {
      const { left, right, top, bottom } = element.getBoundingClientRect();
      return [0.05, 0.5, 0.95].every((share) =>
        element.contains(document.elementFromPoint(left + share * (right - left), (top + bottom) / 2)),
      );
    });
    assert.ok(isOnTop, "no panel covers it");
    await banner.getByRole("button").click();
    await banner.waitFor({ state: "detached" });
    for (const key of ["x", "u"]) {
      await page.keyboard.press(key);
    }
  });

  it("is loaded anew with a part in the hand: one goes on with it, or lets it go", async () => {
    await liftShaft(page);
    await page.mouse.up();
    await page.reload();
    await waitForPicture(page);
    await waitForState(page, (state) => state.hasLease);  // nobody else wants it
    await waitForState(page, ({ held }) => held[0]?.occurrence === kShaft);
    await takePicture(page, "fault_reloaded");
    await goesOn(page);
    await page.keyboard.press("r");
    await waitForPlacement(page, kShaft, "loose");
  });

  it("says that the connection is lost when the program ends", async () => {
    await studio.stop();
    await waitForState(page, ({ link }) => link === "lost");
    await page.getByText(/connection is lost/i).first().waitFor();
    await takePicture(page, "fault_lost");
  });
});

describe("a server that stands still", () => {
  /** Until the picture is so old [ms]. */
  const ages = (page, ms) => waitForState(page, ({ ageMs }) => ageMs > ms);

  it("is said after a second, and the age of the picture is right when it goes on", withStudio([kBushing], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await waitForState(page, ({ ageMs }) => ageMs < 400);
    for (const stallMs of [700, 2500]) {
      studio.freeze();
      await ages(page, stallMs);
      if (stallMs > 1000) {
        await page.getByTestId("silent").waitFor();
        assert.equal(await page.getByTestId("link").getAttribute("data-link"), "silent");
        await takePicture(page, "fault_silent");
      }
      studio.thaw();
      await waitForState(page, ({ isSilent, ageMs }) => !isSilent && ageMs < 400);
    }
    await page.getByTestId("silent").waitFor({ state: "detached" });
    assert.equal(await page.getByTestId("link").getAttribute("data-link"), "open");
    await page.getByTestId("age").filter({ hasText: / ms$/ }).waitFor();
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("is said where nothing is open, too", withStudio([], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await page.getByTestId("drop-zone").waitFor();
    await waitForState(page, ({ link }) => link === "open");
    studio.freeze();
    await page.getByTestId("silent").waitFor();
    studio.thaw();
    await page.getByTestId("silent").waitFor({ state: "detached" });
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
    const sent = page.getByTestId("loading").getByRole("progressbar");
    await sent.and(page.locator(':not([aria-valuenow="0"])')).waitFor();  // some of it is on its way
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
    await page.getByTestId("loading").locator('[role="progressbar"]:not([aria-label="Sending"])').waitFor();
    await page.getByTestId("cancel-open").click();
    await page.getByTestId("loading").waitFor({ state: "detached" });
    await page.getByRole("log").filter({ hasText: "opening was cancelled" }).waitFor({ state: "attached" });  // the server's last word on this file
    assert.equal(await page.getByTestId("failure").count(), 0, "nothing is complained about");
    assert.equal((await fetchScene(page)).epoch, epoch);
    assert.equal((await stateOf(page)).hasScene, true);
    await takePicture(page, "open_cancelled");
    await page.context().close();
  }));
});
