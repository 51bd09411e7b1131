// The studio as a person uses it, in Debian's Chromium. `npm run e2e`; pictures of what was seen go to
// $HVAS_PICTURES.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { readFileSync } from "node:fs";
import {
  browser,
  dropFile,
  fetchScene,
  findBarriers,
  findOutside,
  insertByMouse,
  openPage,
  poseOf,
  seeOtherwise,
  shareBrowser,
  shareStudio,
  takeOutByMouse,
  takePicture,
  waitForCalm,
  waitForPicture,
  waitForPlacement,
  waitForState,
  watchFor,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kPump = "../products/gear_pump.step";

shareBrowser();

describe("the page", () => {
  it("shows the pump, hides the token, and the browser has nothing against it", withStudio([kPump], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator, { isPlain: false });
    await waitForPicture(page);
    assert.ok(!page.url().includes("t="), "the token has left the address");
    assert.equal((await page.evaluate(() => document.cookie)).length, 0, "no script can read the cookie");
    await takePicture(page, "pump");
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("does not let in whoever has no token", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, `${studio.origin}/`);
    await waitForState(page, ({ link }) => link === "denied");
    await waitForCalm(page);
    await takePicture(page, "no_token");
    assert.match(await page.textContent("body"), /link|token/i);
    const status = await page.evaluate(async () => (await fetch("/api/scene")).status);
    assert.equal(status, 401);
    await page.context().close();
  }));

  it("opens a file that is dropped on it, and says what is wrong with one that is none", withStudio([], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await page.getByTestId("drop-zone").waitFor();
    await dropFile(page, "broken.step", "this is no STEP file");
    await page.getByText(/broken\.step/).first().waitFor();
    await takePicture(page, "broken_file");
    await dropFile(page, "bushing.step", readFileSync(kBushing, "utf8"));
    await waitForPicture(page);
    assert.equal((await fetchScene(page)).name.length > 0, true);
    await page.context().close();
  }));
});

describe("the hand", () => {
  it("inserts bushing and shaft with the mouse alone; undo and redo", withStudio([kBushing], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator, { isPlain: false });
    await waitForPicture(page);
    const scene = await fetchScene(page);
    const guide = page.getByTestId("guide");
    assert.deepEqual(await guide.getByRole("listitem").allInnerTexts(), [
      "1\nTake bushing: press on it and drag.",
      "2\nBring it near its place, shown in green.",
      "3\nPush it in until it is seated.",
    ]);
    assert.equal(await guide.locator("[aria-current=step]").getAttribute("data-testid"), "guide-take");
    for (const step of scene.steps.filter((s) => s.kind === "insert")) {
      await insertByMouse(page, step.occurrence, scene.occurrences[step.occurrence].goal.p);
      await guide.waitFor({ state: "detached" }); // Whoever has put one in needs no guide.
      await takePicture(page, `inserting_${step.occurrence}`);
      await page.mouse.up();
      await waitForPlacement(page, step.occurrence, "placed");
    }
    await takePicture(page, "assembled");
    await page.reload();
    await waitForPicture(page);
    assert.equal(await guide.count(), 0, "nor at the next visit");
    const last = scene.steps.at(-1).occurrence;
    await page.keyboard.press("Control+z");
    await waitForPlacement(page, last, "loose");
    await page.locator('[data-testid="button-redo"]:not([disabled]):not([aria-disabled="true"])').waitFor();
    await page.keyboard.press("Control+Shift+z");
    await waitForPlacement(page, last, "placed");
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("rests while the forces are off, and everybody may switch them off", withStudio([kBushing], async (studio) => {
    const operator = await openPage(browser, studio.operator);
    await waitForPicture(operator.page);
    const viewer = await openPage(browser, studio.viewer);
    await waitForPicture(viewer.page);
    await takePicture(viewer.page, "viewer");
    await viewer.page.getByRole("button", { name: /forces off/i }).first().click();
    await operator.page.waitForFunction(() => /forces are off/i.test(document.body.innerText));
    await takePicture(operator.page, "forces_off");
    await operator.page.context().close();
    await viewer.page.context().close();
  }));

});

describe("what the simulated person has put together", () => {
  const kShaft = 2;
  const studio = shareStudio([kBushing]);
  let page;
  let complaints;
  before(async () => {
    ({ page, complaints } = await openPage(browser, studio.operator));
    await waitForPicture(page);
    const isTold = await watchFor(page, "[data-testid=demo-runs]");
    await page.getByRole("button", { name: /Auto-assemble/ }).first().click();
    await waitForState(page, ({ placements, demo }) => placements[1] === "placed" && placements[kShaft] === "placed" && !demo);
    assert.ok(await isTold(), "the page says that the simulated person works");
    await page.getByTestId("demo-runs").waitFor({ state: "detached" });
  });
  after(() => page.context().close());

  it("is all in its place", async () => {
    await waitForPlacement(page, 1, "placed");
    await waitForPlacement(page, kShaft, "placed");
    await takePicture(page, "demo");
  });

  it("has come there on a way that is shown, as points and as the room that it needs", async () => {
    await page.getByTestId("part-2").click({ button: "right" });
    await page.getByText("Show its path as points").click();
    await page.getByText("Turning").waitFor();
    await takePicture(page, "path_points");
    await page.getByTestId("part-2").click({ button: "right" });
    const mesh = page.waitForResponse((response) => response.url().includes("/api/path/"));
    await page.getByText("Show its path as swept volume").click();
    await page.getByText("Maximum deviation").waitFor();
    await (await mesh).finished();
    await waitForCalm(page);
    await takePicture(page, "path_swept");
    await page.getByTestId("path-panel").getByRole("button", { name: "Close" }).click();
    assert.deepEqual(complaints, []);
  });

  it("X16: a part is got out by the simulated person, with what has to come out first", async () => {
    await page.getByTestId("part-1").click();  // the bushing, with the shaft in it
    await page.getByTestId("plan-removal").click();
    await page.getByTestId("removals").waitFor();
    await takePicture(page, "removal_plan");
    assert.match(await page.getByTestId("removals").innerText(), /mm of way/);
    await page.getByTestId("take-out").click();
    await waitForPlacement(page, 1, "loose");
    await waitForState(page, ({ demo }) => !demo);
    assert.deepEqual(complaints, []);
    await page.keyboard.press("Control+z");
    await waitForPlacement(page, 1, "placed");
    await waitForPlacement(page, kShaft, "placed");
  });

  it("comes apart again with the mouse alone: a shaft is drawn out of its bore", async () => {
    const { goal } = (await fetchScene(page)).occurrences[kShaft];
    await takeOutByMouse(page, kShaft, goal.p);
    await takePicture(page, "taken_out");
    assert.ok((await poseOf(page, kShaft)).p[2] - goal.p[2] > 0.047, "it is longer than its bore is deep");
    await page.mouse.up();
    await page.keyboard.press("r");
    await waitForPlacement(page, kShaft, "loose");
    await page.keyboard.press("Control+z");
    await waitForPlacement(page, kShaft, "placed");
    assert.deepEqual(complaints, []);
  });
});

describe("everybody", () => {
  it("can use it in German, in forced colours and at 200 %: nothing is out of the screen", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.viewer, { viewport: { width: 1280, height: 720 }, locale: "de-DE" });
    await waitForPicture(page);
    await seeOtherwise(page, async (way) => {
      await waitForCalm(page);
      assert.deepEqual(await findBarriers(page), [], way);
      assert.deepEqual(await findOutside(page), [], way);
      await takePicture(page, `desk_${way}`.replaceAll(/[ %]+/g, "_"));
    });
    await page.context().close();
  }));
});
