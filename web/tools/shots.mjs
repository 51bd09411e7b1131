// Pictures of the page in its states, by headless Chromium and the program itself, into shots/:
//   npm run shots -- [--file ../products/gear_pump.step] [--only dark,light]

import { mkdirSync } from "node:fs";
import { parseArgs } from "node:util";
import { launchBrowser, openPage, startStudio, waitForPicture } from "../e2e/harness.mjs";

const { values: options } = parseArgs({
  options: {
    file: { type: "string", default: "../products/gear_pump.step" },
    only: { type: "string", default: "" },
  },
});

const wait = (page, ms) => page.waitForTimeout(ms);

/** Records how the simulated person puts a part in. */
async function record(page) {
  await page.getByTestId("rec").click();
  await wait(page, 500);
  await page.keyboard.press("n");
  await wait(page, 6000);
  await page.getByTestId("rec").click();
  await page.getByTestId("open-last").waitFor();
}

/** So that there are two to choose from. */
async function recordTwice(page) {
  await record(page);
  await page.keyboard.press("n");
  await wait(page, 6000);
  await record(page);
}

async function play(page) {
  await record(page);
  await page.getByTestId("open-last").click();
  await page.getByTestId("playing").waitFor();
  await page.getByTestId("timeline").focus();
  await page.keyboard.press("End");
  for (let k = 0; k < 3; k++) {
    await page.keyboard.press("PageDown");
  }
  await wait(page, 900);
}

async function openList(page) {
  await recordTwice(page);
  await page.getByTestId("open-recordings").click();
  await wait(page, 800);
}

async function compare(page) {
  await openList(page);
  const boxes = page.locator('[data-testid="recordings"] input[type="checkbox"]');
  await boxes.nth(0).check();
  await boxes.nth(1).check();
  await page.getByTestId("compare-chosen").click();
  await wait(page, 1200);
}

async function openDevices(page) {
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press("Control+k");
  await page.getByTestId("palette-input").fill("devices");
  await page.keyboard.press("Enter");
  await page.getByTestId("devices").waitFor();
  await page.getByTestId("hands-2").click();
  await wait(page, 2500);
}

async function rates(page) {
  await page.getByTestId("tab-rates").click();
  await wait(page, 1500);
}
const states = {
  dark: { async go(page) { await wait(page, 500); } },
  light: { theme: "light", async go(page) { await page.getByTestId("part-1").first().click(); await wait(page, 600); } },
  small: { size: [1280, 720], async go(page) { await page.keyboard.press("x"); await wait(page, 800); } },
  german: { locale: "de-DE", async go(page) { await page.getByTestId("menu.view").click(); await wait(page, 400); } },
  tablet: { size: [834, 1112], theme: "light", async go(page) { await wait(page, 600); } },
  explode: { async go(page) { await page.keyboard.press("b"); await wait(page, 900); } },
  demo: { async go(page) { await page.keyboard.press("n"); await wait(page, 2600); } },
  demoLight: { theme: "light", async go(page) { await page.keyboard.press("n"); await wait(page, 2800); } },
  shortcuts: { async go(page) { await page.keyboard.press("?"); await wait(page, 500); } },
  playing: { size: [1280, 720], go: play },
  playingLight: { size: [1280, 720], theme: "light", locale: "de-DE", go: play },
  recordings: { size: [1280, 720], go: openList },
  compare: { size: [1280, 720], go: compare },
  compareLight: { size: [1280, 720], theme: "light", go: compare },
  devices: { size: [1280, 720], go: openDevices },
  devicesLight: { size: [1280, 720], theme: "light", go: openDevices },
  rates: { size: [1280, 720], go: rates },
  ratesLight: { size: [1280, 720], theme: "light", go: rates },
  palette: { theme: "light", async go(page) { await page.keyboard.press("Control+k"); await wait(page, 500); } },
};

const wanted = options.only === "" ? Object.keys(states) : options.only.split(",");
mkdirSync("shots", { recursive: true });
const browser = await launchBrowser();
for (const name of wanted) {
  const { size = [1440, 900], theme = "dark", locale = "en-US", go } = states[name];
  const studio = await startStudio([options.file], { clock: "machine" });
  const look = { viewport: { width: size[0], height: size[1] }, colorScheme: theme, locale, isPlain: false };
  const { page, complaints } = await openPage(browser, studio.operator, look);
  await waitForPicture(page);
  await go(page);
  await page.screenshot({ path: `shots/${name}.png` });
  console.log(name, JSON.stringify(await page.evaluate(() => ({ drawn: window.hvas.framesDrawn, shared: window.hvas.state().isShared }))));
  complaints.forEach((complaint) => console.log(name, complaint));
  await page.context().close();
  await studio.stop();
}
await browser.close();
