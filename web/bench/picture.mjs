// How soon the page has its picture, and what it pays for moving parts: `npm run picture` with the program in
// HVAS_BINARY. Figures are for docs/studio.md.
import { fetchScene, launchBrowser, openPage, startStudio, waitForPicture } from "../e2e/harness.mjs";
import { quantile } from "./quantile.mjs";

const kVisits = 7;
const kUpdates = 300;

/** Opened anew each time, with nothing in the browser's cache; the program has opened the product. */
async function timeFirstPicture(browser, file) {
  const studio = await startStudio([file]);
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
  const studio = await startStudio([file]);
  try {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const parts = (await fetchScene(page)).occurrences.length;
    return { parts, times: await page.evaluate((count) => window.hvas.timePoses(count), kUpdates) };
  } finally {
    await studio.stop();
  }
}

const browser = await launchBrowser();
const first = await timeFirstPicture(browser, "../products/gear_pump.step");
const poses = await timePoses(browser, "../products/frame_500.step");
await browser.close();
console.log(
  JSON.stringify(
    {
      first_picture_ms_p50: quantile(first, 0.5),
      first_picture_ms_max: Math.max(...first),
      moved_parts: poses.parts,
      poses_ms_p50: quantile(poses.times, 0.5),
      poses_ms_p99: quantile(poses.times, 0.99),
    },
    null,
    2,
  ),
);
