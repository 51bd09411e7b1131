// What was recorded is seen and felt again as it was (X13, X15, N7 of the requirements, docs/studio.md).
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, it } from "node:test";
import {
  browser,
  dropFile,
  fetchScene,
  findBarriers,
  nextFrame,
  openPage,
  poseOf,
  shareBrowser,
  shareStudio,
  stateOf,
  takePicture,
  waitForCalm,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kPump = "../products/gear_pump.step";
const kBushingPart = 1;

shareBrowser();

function assertSamePose(a, b) {
  [...a.p, ...a.q].forEach((v, k) => assert.ok(Math.abs(v - [...b.p, ...b.q][k]) < 1e-6, `${JSON.stringify(a)} is not ${JSON.stringify(b)}`));
}

/** Records how the simulated person puts a part in; the poses before and after. */
async function recordStep(page, occurrence) {
  const before = await poseOf(page, occurrence);
  await page.getByTestId("rec").click();
  await waitForState(page, (state) => state.recording !== null);
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press("n");
  await waitForPlacement(page, occurrence, "placed");
  const after = await waitForRest(page, occurrence, { most: 1e-7 }); // It is compared to 1e-6.
  await page.getByTestId("rec").click();
  await page.getByTestId("open-last").waitFor();
  return { before, after };
}

async function openLast(page) {
  await page.getByTestId("open-last").click();
  await page.getByTestId("playing").waitFor();
  return waitForState(page, (state) => state.hasScene && state.playback !== null && state.hands.length > 0);
}

describe("a recording", () => {
  const studio = shareStudio([kBushing]);
  let page;
  let complaints;
  let poses;
  before(async () => {
    ({ page, complaints } = await openPage(browser, studio.operator, { acceptDownloads: true }));
    await waitForPicture(page);
    poses = await recordStep(page, kBushingPart);
  });
  after(() => page.context().close());

  it("plays as it was: any moment, forward and back, by keys, mouse and link", async () => {
    const opened = await openLast(page);
    assert.equal(opened.placements[kBushingPart], "loose");
    const kinds = opened.playback.marks.map((mark) => mark.kind);
    for (const kind of ["taken", "captured", "seated", "dropped"]) {
      assert.ok(kinds.includes(kind), `${kind} is marked: ${kinds}`);
    }
    await nextFrame(page, 2);
    assertSamePose(await poseOf(page, kBushingPart), poses.before);

    await page.getByTestId("timeline").focus();
    await page.keyboard.press("End");
    await waitForState(page, (state) => state.placements[1] === "placed");
    await nextFrame(page, 2);
    assertSamePose(await poseOf(page, kBushingPart), poses.after);
    await takePicture(page, "recording_end");

    await page.keyboard.press("Home");
    await waitForState(page, (state) => state.placements[1] === "loose");
    await page.keyboard.press("PageUp");
    const oneSecond = (await stateOf(page)).playback.timeS;
    assert.ok(Math.abs(oneSecond - 1) < 1e-6);
    await page.keyboard.press("ArrowRight");
    const oneFrame = (await stateOf(page)).playback.timeS - oneSecond;
    assert.ok(oneFrame > 0 && oneFrame < 0.2, `a frame is ${oneFrame} s`);

    await page.getByTestId("speed").selectOption("8");
    await page.getByTestId("button-play").click();
    await waitForState(page, (state) => !state.playback.isPlaying && state.placements[1] === "placed");
    await nextFrame(page, 2);
    assertSamePose(await poseOf(page, kBushingPart), poses.after);

    const box = await page.getByTestId("timeline").boundingBox();
    await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.3 * box.height);
    const middle = await waitForState(page, ({ playback }) => Math.abs(playback.timeS / playback.durationS - 0.4) < 0.02);
    await takePicture(page, "recording_middle");
    await page.getByTestId("button-share").click();
    await page.waitForFunction(() => /#t=/.test(document.querySelector('[data-testid="share-link"]')?.value ?? ""));
    const other = await openPage(browser, await page.getByTestId("share-link").inputValue(), { isStranger: true });
    await page.keyboard.press("Escape");
    await other.page.getByTestId("playing").waitFor();
    const shared = await waitForState(other.page, (state) => state.playback !== null && state.hasScene);
    assert.ok(Math.abs(shared.playback.timeS - middle.playback.timeS) < 2e-3, "the link leads to the moment");
    await other.page.context().close();

    // Dragging begins on the mark of an event as well as beside it; a click there goes to its moment.
    const marked = middle.playback.marks.find(({ kind }) => kind === "captured");
    const mark = page.locator(".mark.is-captured").first();
    const at = await mark.boundingBox();
    await page.mouse.click(at.x + at.width / 2, at.y + at.height / 2);
    await waitForState(page, ({ playback }) => Math.abs(playback.timeS - marked.timeS) < 1e-6);
    await page.mouse.move(at.x + at.width / 2, at.y + at.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.8 * box.width, at.y + 5, { steps: 5 });
    await waitForState(page, ({ playback }) => Math.abs(playback.timeS / playback.durationS - 0.8) < 0.02);
    await page.mouse.move(box.x + 0.2 * box.width, at.y + 5, { steps: 5 });
    await waitForState(page, ({ playback }) => Math.abs(playback.timeS / playback.durationS - 0.2) < 0.02);
    await page.mouse.up();

    await page.getByTestId("back-to-live").click();
    const live = await waitForState(page, (state) => state.playback === null && state.placements[1] === "placed");
    assert.ok(live.hasLease);
    assert.deepEqual(complaints, []);
  });

  it("is in a list, which opens, downloads, compares and deletes; axe finds nothing", async () => {
    await page.keyboard.press("Control+z");
    await waitForPlacement(page, kBushingPart, "loose");
    await recordStep(page, kBushingPart);
    await page.getByTestId("open-recordings").click();
    const rows = page.locator('[data-testid="recordings"] tbody tr');
    await rows.nth(1).waitFor();
    const count = await rows.count();
    await takePicture(page, "recordings");
    assert.deepEqual(await findBarriers(page), []);

    const names = await rows.getByRole("rowheader").allInnerTexts();
    assert.equal(new Set(names).size, count, `each has a name of its own: ${names}`);
    await rows.first().getByRole("button", { name: /^Rename/ }).click();
    await page.getByTestId("recording-name").fill("Schräg angesetzt");
    await takePicture(page, "recording_rename");
    await page.keyboard.press("Enter");
    await rows.first().getByRole("button", { name: "Schräg angesetzt", exact: true }).waitFor();
    await page.evaluate(() => fetch("/api/recordings").then((r) => r.json())).then(({ recordings }) =>
      assert.equal(recordings[0].name, "Schräg angesetzt"),
    );

    const [download] = await Promise.all([page.waitForEvent("download"), rows.first().getByRole("link").click()]);
    assert.match(download.suggestedFilename(), /\.hvasrec$/);
    assert.equal(readFileSync(await download.path()).subarray(0, 15).toString(), "SQLite format 3");

    for (const k of [0, 1]) {
      await rows.nth(k).getByRole("checkbox").check();
    }
    await page.getByTestId("compare-chosen").click();
    await page.getByTestId("compare-table").waitFor();
    await page.getByTestId("compare-part").selectOption({ index: 1 });
    await page.getByRole("radio", { name: "Depth" }).click();
    await waitForCalm(page);
    assert.match(await page.getByTestId("compare-table").innerText(), /%/);
    await takePicture(page, "compare");
    assert.deepEqual(await findBarriers(page), []);

    await page.getByTestId("open-recordings").click();
    await rows.first().getByRole("button", { name: /^Delete/ }).click();
    await page.getByTestId("confirm-delete").click();
    await page.waitForFunction(
      (left) => document.querySelectorAll('[data-testid="recordings"] tbody tr').length === left,
      count - 1,
    );
    await page.keyboard.press("Escape");
  });

  it("of another product brings that product, and live work comes back after it", async () => {
    await dropFile(page, "gear_pump.step", readFileSync(kPump, "utf8"));
    const isPump = (state) => Object.keys(state.placements).length === 38;
    await waitForState(page, isPump);
    await page.getByTestId("open-recordings").click();
    await page.getByTestId("recordings").getByRole("button", { name: /^Play/ }).click();  // there is no other one
    await waitForState(page, (state) => Object.keys(state.placements).length === 3);
    await takePicture(page, "recording_of_another");
    await page.getByTestId("back-to-live").click();
    await waitForState(page, isPump);
    assert.equal((await fetchScene(page)).occurrences.length, 38);
  });
});
