// Pictures of the studio in its states for docs/studio_pictures.md, by headless Chromium and the program itself:
//   node tools/pictures.mjs [--out ../docs/pictures/studio] [--only phone]
// The program is build/release/src/app/hvas, as for the tests of the page.

import { mkdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { parseArgs } from "node:util";
import {
  fetchScene,
  launchBrowser,
  openPage,
  poseOf,
  startStudio,
  takeByMouse,
  waitForCalm,
  waitForPicture,
  waitForState,
  waitForStill,
  waitForView,
} from "../e2e/harness.mjs";

const { values: options } = parseArgs({
  options: { out: { type: "string", default: "../docs/pictures/studio" }, only: { type: "string", default: "" } },
});
const kDesk = { viewport: { width: 1280, height: 760 } };
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kTablet = { viewport: { width: 820, height: 1180 }, hasTouch: true, isMobile: true };
const kQuality = 72;
/** The page shows where the results of a study are. */
const kResults = join(tmpdir(), "xia-2011");
const kStudy = ["--study", "xia-2011", "--participant", "P01", "-o", kResults];

/** Somebody who has put a part in by hand before is not guided any more. */
const leaveUnguided = (page) => page.addInitScript(() => localStorage.getItem("hvas-studio") ?? localStorage.setItem("hvas-studio", '{"guidesFirstPart":false}'));

const project = (page, p) => page.evaluate((point) => window.hvas.project(point), p);

/** Products of hundreds of parts take minutes until the last one is ready. */
async function waitForWhole(page, tries = 6) {
  try {
    await waitForPicture(page);
  } catch (error) {
    if (tries === 0) {
      throw error;
    }
    await waitForWhole(page, tries - 1);
  }
}

/** Takes the first part to above its place, at this height [m]. */
async function carry(page, height = 0.1) {
  const scene = await fetchScene(page);
  const { occurrence } = scene.steps.find(({ kind }) => kind === "insert");
  const [x, y, z] = scene.occurrences[occurrence].goal.p;
  await takeByMouse(page, occurrence);
  const over = await project(page, [x, y, z + height]);
  await page.mouse.move(over.x, over.y, { steps: 8 });
  await waitForStill(page, async () => ({ p: (await poseOf(page, occurrence)).p }));
  return { occurrence, goal: [x, y, z] };
}

async function mate(page) {
  const { occurrence, goal } = await carry(page);
  const half = await project(page, [goal[0], goal[1], goal[2] + 0.03]);
  await page.mouse.move(half.x, half.y, { steps: 8 });
  await waitForState(page, ({ held }) => ["captured", "mating"].includes(held[0]?.state));
  return { occurrence, goal };
}

async function seat(page) {
  const { occurrence, goal } = await mate(page);
  const into = await project(page, [goal[0], goal[1], goal[2] - 0.01]);
  await page.mouse.move(into.x, into.y, { steps: 8 });
  await waitForState(page, ({ held, placements }) => held[0]?.state === "seated" || placements[occurrence] === "placed");
}

/** Somebody else has joined with a hand, and points to the part that the first one holds. */
async function joinIn(page, studio) {
  const { page: other } = await openPage(browser, studio.operator, { ...kDesk, reducedMotion: "reduce" });
  await waitForPicture(other);
  await other.getByTestId("button-share").click();
  await other.getByTestId("own-name").fill("Ada");
  await other.getByTestId("own-name").blur();
  await other.keyboard.press("Escape");
  await other.getByTestId("hint-join").click();
  await page.getByTestId("lease-asked").getByRole("button").first().click();
  await waitForState(page, ({ hands }) => hands.length === 2);
  const { occurrence } = await carry(page);
  await page.mouse.up();
  const at = await other.evaluate((id) => window.hvas.screen(id), occurrence);
  await other.mouse.move(at.x, at.y, { steps: 4 });
  await page.getByTestId("cursor-c2").waitFor();
}

/** The simulated person puts all parts in. */
async function finish(page) {
  await page.keyboard.press("d");
  await page.getByTestId("summary").waitFor({ timeout: 120_000 });
}

/** As in a headset, side by side. */
async function seeWithTwoEyes(page) {
  await page.getByTestId("menu.view").click();
  await page.getByTestId("menu-stereo-side").click();
}

const kStates = [
  { name: "first_view", product: "gear_pump", screen: kDesk },
  { name: "guided", product: "bushing", screen: kDesk, isGuided: true },
  { name: "carrying", product: "bushing", screen: kDesk, act: carry },
  { name: "mating", product: "bushing", screen: kDesk, act: mate },
  { name: "seated", product: "bushing", screen: kDesk, act: seat },
  { name: "finished", product: "bushing", screen: kDesk, act: finish },
  { name: "workshop", product: "gear_pump", screen: kDesk, act: (page) => page.keyboard.press("u") },
  { name: "two_eyes", product: "gear_pump", screen: kDesk, act: seeWithTwoEyes },
  { name: "phone", product: "gear_pump", screen: kPhone },
  { name: "phone_steps", product: "gear_pump", screen: kPhone, act: (page) => page.getByTestId("phone-steps").tap() },
  { name: "tablet", product: "gear_pump", screen: kTablet },
  { name: "two_people", product: "bushing", screen: kDesk, act: joinIn },
  { name: "start_page", product: null, screen: kDesk, act: (page) => page.getByTestId("start-devices").waitFor() },
  { name: "study", product: null, isStudy: true, screen: kDesk, act: (page) => page.getByTestId("desk-phase").waitFor() },
  { name: "many_parts", product: "frame_500", screen: kDesk },
];

mkdirSync(options.out, { recursive: true });
const browser = await launchBrowser();
for (const { name, product, screen, act, isGuided = false, isStudy = false } of kStates.filter((each) => each.name.includes(options.only))) {
  for (const colorScheme of ["light", "dark"]) {
    rmSync(kResults, { recursive: true, force: true });
    const studio = await startStudio(isStudy ? kStudy : product === null ? [] : [`../products/${product}.step`]);
    const beforeLoad = isGuided ? null : leaveUnguided;
    const { page } = await openPage(browser, studio.operator, { ...screen, colorScheme, isPlain: false, reducedMotion: "reduce", beforeLoad });
    if (product !== null) {
      await waitForWhole(page);
    }
    await act?.(page, studio);
    await waitForCalm(page);
    if (product !== null) {
      await waitForView(page);
    }
    await page.screenshot({ path: join(options.out, `${name}_${colorScheme}.jpg`), type: "jpeg", quality: kQuality });
    await page.context().close();
    await studio.stop();
    console.log(`${name}_${colorScheme}.jpg`);
  }
}
await browser.close();
