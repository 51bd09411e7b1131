// A studio of one's own for each test, and a browser that looks at it as a person would.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { chromium } from "playwright-core";

const kProgram = process.env["HVAS_BINARY"] ?? "../build/dev/src/app/hvas";
const kPictures = process.env["HVAS_PICTURES"] ?? "../build/pictures";
const kChromium = process.env["HVAS_CHROMIUM"] ?? "/usr/bin/chromium";
mkdirSync(kPictures, { recursive: true });

/** Starts `hvas studio`; its links, and how to end it. */
export async function startStudio(args = []) {
  const child = spawn(kProgram, ["studio", "--no-open", ...args], { stdio: ["ignore", "pipe", "inherit"] });
  let said = "";
  await new Promise((resolve, reject) => {
    child.stdout.on("data", (bytes) => {
      said += bytes;
      if (said.includes("ends it")) {
        resolve();
      }
    });
    child.on("exit", (code) => reject(new Error(`hvas studio ended with ${code}: ${said}`)));
  });
  const links = said.match(/http:\S+/g);
  const operator = links[0];
  const ended = new Promise((resolve) => child.removeAllListeners("exit").on("exit", resolve));
  return {
    operator,
    viewer: links.at(-1),
    participant: links.length === 3 ? links[1] : null,  // of a study
    origin: new URL(operator).origin,
    stop: async () => {
      child.kill("SIGTERM");
      return ended;
    },
  };
}

/** With the token of a link, as its page does it; where, and the cookie that is worth as much. */
export async function signIn(link) {
  const { origin, hash } = new URL(link);
  const answer = await fetch(`${origin}/api/session`, {
    method: "POST",
    headers: { "Content-Type": "application/json", Origin: origin },
    body: JSON.stringify({ token: hash.slice("#t=".length) }),
  });
  assert.equal(answer.status, 200);
  return { origin, cookie: answer.headers.get("set-cookie").split(";")[0] };
}

/** Runs a test with a studio, which ends with it. */
export function withStudio(args, run) {
  return async () => {
    const studio = await startStudio(args);
    try {
      await run(studio);
    } finally {
      assert.equal(await studio.stop(), 0, "it ends well when it is told to");
    }
  };
}

/** Runs `hvas` to its end; what it prints. */
export function runProgram(args) {
  return execFileSync(kProgram, args, { encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
}

/** A copy of a file in a folder of its own, with what belongs to it beside it. */
export function copyToTemporary(files) {
  const folder = mkdtempSync(join(tmpdir(), "hvas-e2e-"));
  for (const file of files) {
    copyFileSync(file, join(folder, basename(file)));
  }
  return join(folder, basename(files[0]));
}

export function launchBrowser() {
  return chromium.launch({
    executablePath: kChromium,
    args: ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

/** A page with a studio in it. `complaints`: what the browser has to say against it. `beforeLoad` gets the page
 before there is anything in it.
 @param {import("playwright-core").Browser} browser  Of a known type, so that the linter sees steps that nobody waits for. */
export async function openPage(browser, link, { beforeLoad = null, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") {
      complaints.push(message.text());
    }
  });
  await beforeLoad?.(page);
  await page.goto(link);
  return { page, complaints };
}

/** Until this much of a scene has been drawn. */
export async function waitForPicture(page, frames = 3) {
  await page.waitForFunction(
    (count) => window.hvas && window.hvas.state().hasScene && window.hvas.framesDrawn > count,
    frames,
    { timeout: 60_000 },
  );
}

export function takePicture(page, name) {
  return page.screenshot({ path: join(kPictures, `${name}.png`) });
}

export function fetchScene(page) {
  return page.evaluate(async () => (await fetch("/api/scene")).json());
}

/** Until a part is there: "loose", "held", "placed". */
export async function waitForPlacement(page, occurrence, placement, timeout = 30_000) {
  const end = Date.now() + timeout;
  let found = "";
  while (Date.now() < end) {
    found = (await fetchScene(page)).occurrences?.[occurrence].placement; // none while it is being changed
    if (found === placement) {
      return;
    }
    await page.waitForTimeout(200);
  }
  throw new Error(`part ${occurrence} is ${found} and not ${placement} after ${timeout} ms`);
}

/** A file is dragged onto the page and let go there. */
export function dropFile(page, name, text) {
  return page.evaluate(
    ([fileName, content]) => {
      const data = new DataTransfer();
      data.items.add(new File([content], fileName));
      for (const kind of ["dragenter", "dragover", "drop"]) {
        document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
      }
    },
    [name, text],
  );
}

/** What axe has against the page as it is; the page has to be opened with `bypassCSP`. */
export async function findBarriers(page) {
  await page.addScriptTag({ path: "node_modules/axe-core/axe.min.js" });
  const found = await page.evaluate(() => window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21aa", "wcag22aa"] }));
  return found.violations.map((v) => `${v.id}: ${v.nodes[0]?.html}`);
}

export function stateOf(page) {
  return page.evaluate(() => window.hvas.state());
}

/** Until what the page knows is so; returns it. */
export async function waitForState(page, isSo, timeout = 20_000) {
  const end = Date.now() + timeout;
  let state;
  while (Date.now() < end) {
    state = await stateOf(page);
    if (isSo(state)) {
      return state;
    }
    await page.waitForTimeout(50);
  }
  throw new Error(`not so after ${timeout} ms: ${isSo}, but ${JSON.stringify(state)}`);
}

/** Of a part, as the page draws it, in W. */
export function poseOf(page, occurrence) {
  return page.evaluate((id) => window.hvas.pose(id), occurrence);
}

/** Between the origins of two poses [m]. */
export function distance(a, b) {
  return Math.hypot(...a.p.map((v, k) => v - b.p[k]));
}

/** Clicks where one sees this face of a part. */
export async function clickFace(page, occurrence, face) {
  const at = await page.evaluate(([o, f]) => window.hvas.screenOfFace(o, f), [occurrence, face]);
  assert.ok(at, `face ${face} of part ${occurrence} is to be seen`);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.up();
}

/** Presses on a part and drags it a little: it is in the hand then. */
export async function takeByMouse(page, occurrence) {
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + 8, at.y - 8, { steps: 3 });  // from here on it is no click
  await waitForPlacement(page, occurrence, "held");
}

/** Selects a part that is in its place, and draws it out upwards; the button stays down. */
export async function takeOutByMouse(page, occurrence, goal, height = 0.12) {
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  await page.mouse.click(at.x, at.y);
  await page.waitForFunction((id) => window.hvas.state().selected.includes(id), occurrence);
  await page.waitForTimeout(500);  // or it would be a double click
  await takeByMouse(page, occurrence);
  const [low, high] = await page.evaluate(
    ([[x, y, z], up]) => [window.hvas.project([x, y, z]), window.hvas.project([x, y, z + up])],
    [goal, height],
  );
  const kSteps = 12;
  for (let k = 1; k <= kSteps; k++) {
    const share = k / kSteps;
    await page.mouse.move(at.x + share * (high.x - low.x), at.y + share * (high.y - low.y), { steps: 3 });
    await page.waitForTimeout(250);
  }
}

/** Takes hold of a part with the mouse and moves it over its place and in, as far as it goes. */
export async function insertByMouse(page, occurrence, goal, height = 0.12) {
  await takeByMouse(page, occurrence);
  const kSteps = 14;
  for (let k = 0; k <= kSteps; k++) {
    const above = height * (1 - k / (kSteps - 2));
    const to = await page.evaluate(([x, y, z]) => window.hvas.project([x, y, z]), [
      goal[0],
      goal[1],
      goal[2] + Math.max(-0.01, above),
    ]);
    await page.mouse.move(to.x, to.y, { steps: 3 });
    await page.waitForTimeout(350);
  }
}
