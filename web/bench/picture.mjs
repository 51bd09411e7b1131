// How soon the page has its picture, what it pays for moving parts, and what the workshop costs: `npm run picture` with
// the program in HVAS_BINARY; `npm run picture -- --only workshop` measures the workshop alone. Figures are for docs/studio.md.
import { parseArgs } from "node:util";
import { fetchScene, launchBrowser, openPage, startStudio, waitForPicture, waitForView } from "../e2e/harness.mjs";
import { quantile } from "./quantile.mjs";

const kVisits = 7;
const kUpdates = 300;
/** With and without the workshop so many pictures are drawn in each turn. */
const kTurns = 12;
const kPictures = 3;

/** Opened anew each time, with nothing in the browser's cache; the program has opened the product. */
async function timeFirstPicture(browser, file) {
  const studio = await startStudio([file], { clock: "machine" });
  const times = [];
  try {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await page.context().close();
    for (let visit = 0; visit < kVisits; visit++) {
      const { page: next } = await openPage(browser, studio.viewer);
      const drawn = await next.waitForFunction(
        () => window.hvas?.state().hasScene && window.hvas.framesDrawn > 0 && performance.now(), // since it was asked for
      );
      times.push(await drawn.jsonValue());
      await next.context().close();
    }
  } finally {
    await studio.stop();
  }
  return times;
}

async function timePoses(browser, file) {
  const studio = await startStudio([file], { clock: "machine" });
  try {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const parts = (await fetchScene(page)).occurrences.length;
    return { parts, times: await page.evaluate((count) => window.hvas.timePoses(count), kUpdates) };
  } finally {
    await studio.stop();
  }
}

/** Times of pictures, each until one of its pixels has been read [ms]: shadows are drawn, and edges are smooth. The
 workshop is switched on and off in turns, so that other work of the machine meets both. */
async function timeWorkshop(file) {
  const studio = await startStudio([file], { clock: "machine" });
  const browser = await launchBrowser({ isSmooth: true });
  const times = { with: [], without: [] };
  try {
    const preferences = JSON.stringify({ quality: "high", showsWorkshop: true });
    const beforeLoad = (page) => page.addInitScript((kept) => localStorage.setItem("hvas-studio", kept), preferences);
    const screen = { viewport: { width: 1920, height: 1080 }, reducedMotion: "reduce", isPlain: false };
    const { page } = await openPage(browser, studio.operator, { ...screen, beforeLoad });
    await waitForPicture(page);
    await page.waitForFunction(() => performance.getEntriesByType("resource").some(({ name }) => name.includes("/workshop-")));
    await waitForView(page);
    for (let turn = 0; turn < kTurns; turn++) {
      for (const kind of ["with", "without"]) {
        times[kind].push(...(await page.evaluate((count) => window.hvas.timePictures(count), kPictures)));
        await page.keyboard.press("u");
        await waitForView(page);
      }
    }
  } finally {
    await browser.close();
    await studio.stop();
  }
  const [withIt, without] = [quantile(times.with, 0.5), quantile(times.without, 0.5)];
  return { workshop_picture_ms_p50: withIt, plain_picture_ms_p50: without, workshop_ratio: withIt / without };
}

async function timeProducts() {
  const browser = await launchBrowser();
  const first = await timeFirstPicture(browser, "../products/gear_pump.step");
  const poses = await timePoses(browser, "../products/frame_500.step");
  await browser.close();
  return {
    first_picture_ms_p50: quantile(first, 0.5),
    first_picture_ms_max: Math.max(...first),
    moved_parts: poses.parts,
    poses_ms_p50: quantile(poses.times, 0.5),
    poses_ms_p99: quantile(poses.times, 0.99),
  };
}

const { only } = parseArgs({ options: { only: { type: "string", default: "" } } }).values;
const kMeasurements = { products: timeProducts, workshop: () => timeWorkshop("../products/gear_pump.step") };
for (const [name, measure] of Object.entries(kMeasurements)) {
  if (name.startsWith(only)) {
    console.log(JSON.stringify(await measure(), null, 2));
  }
}
