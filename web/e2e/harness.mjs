// A studio of one's own for each test, and a browser that looks at it as a person would.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { after, before } from "node:test";
import { chromium } from "playwright-core";
import WebSocket from "ws";

export const kProgram = process.env["HVAS_BINARY"] ?? "../build/release/src/app/hvas";
const kPictures = process.env["HVAS_PICTURES"] ?? "../build/pictures";
const kChromium = process.env["HVAS_CHROMIUM"] ?? "/usr/bin/chromium";
/** For what happens at once where nothing is wrong: no claim, as a busy machine is only slow. */
export const kPatienceMs = 120_000;
const kAxe = readFileSync("node_modules/axe-core/axe.min.js", "utf8");
mkdirSync(kPictures, { recursive: true });

const folders = [];
process.on("exit", () => folders.forEach((folder) => rmSync(folder, { recursive: true, force: true })));

/** An empty folder of one's own, which goes with the tests. */
export function makeFolder() {
  folders.push(mkdtempSync(join(tmpdir(), "hvas-e2e-")));
  return folders.at(-1);
}

/** By link: the cookie of the browser that came by it first. It lets in no other. */
const cookies = new Map();

/** Starts `hvas studio`; its links, and how to end it. It keeps nothing with what its user keeps, and finds nothing there
 but what an earlier one with the same `home` has left. Its session goes on by steps, and waits for the page in whose hand
 a part is; by the clock of the machine for who measures. */
export async function startStudio(args = [], { home = makeFolder(), clock = "steps" } = {}) {
  const child = spawn(kProgram, ["studio", "--no-open", "--clock", clock, ...args], {
    stdio: ["ignore", "pipe", "inherit"],
    env: { ...process.env, XDG_DATA_HOME: home, XDG_STATE_HOME: home },
  });
  let said = "";
  await new Promise((resolve, reject) => {
    child.stdout.on("data", (bytes) => {
      said += bytes;
      if (said.includes("to end it")) {
        resolve();
      }
    });
    child.on("exit", (code) => reject(new Error(`hvas studio ended with ${code}: ${said}`)));
  });
  const links = said.match(/https?:\S+/g);
  const operator = links[0];
  const ended = new Promise((resolve) => child.removeAllListeners("exit").on("exit", resolve));
  return {
    operator,
    viewer: links.at(-1),
    participant: /for the participant: (\S+)/.exec(said)?.[1] ?? null,  // of a study
    origin: new URL(operator).origin,
    pid: child.pid,
    /** It stands still, as on a machine that has no time for it; then it goes on. */
    freeze: () => child.kill("SIGSTOP"),
    thaw: () => child.kill("SIGCONT"),
    stop: async () => {
      child.kill("SIGTERM");
      return ended;
    },
    kill: async () => {
      child.kill("SIGKILL");
      return ended;
    },
  };
}

/** Waits until what a studio with this home keeps on disk for its next start fits: it is written soon after what is told. */
export async function waitForKept(home, fits) {
  const end = Date.now() + kPatienceMs;
  const folder = join(home, "hvas", "studio");
  const isKept = () => readdirSync(folder).some((each) => {
    const file = join(folder, each, "work.json");
    return existsSync(file) && fits(JSON.parse(readFileSync(file, "utf8")));
  });
  while (!isKept()) {
    assert.ok(Date.now() < end, `nothing that fits is kept in ${folder}: ${fits}`);
    // eslint-disable-next-line no-restricted-globals -- Between looks at a condition, not in place of one.
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
}

/** With the token of a link, as its page does it; where, and the cookie that is worth as much. */
export async function signIn(link) {
  const { origin, hash } = new URL(link);
  const known = cookies.get(link);
  const answer = await fetch(`${origin}/api/session`, {
    method: "POST",
    headers: { "Content-Type": "application/json", Origin: origin, ...(known === undefined ? {} : { Cookie: known }) },
    body: JSON.stringify({ token: hash.slice("#t=".length) }),
  });
  assert.equal(answer.status, 200);
  cookies.set(link, answer.headers.get("set-cookie").split(";")[0]);
  return { origin, cookie: cookies.get(link) };
}

/** A client without a page: what it is told, from the beginning, and commands. */
export async function connect({ origin, cookie }) {
  const socket = new WebSocket(`${origin.replace("http", "ws")}/ws`, { headers: { Origin: origin, Cookie: cookie } });
  const told = [];
  const waiting = new Set();
  socket.on("message", (data, isBinary) => {
    if (!isBinary) {
      told.push(JSON.parse(data));
      waiting.forEach((look) => look());
    }
  });
  await new Promise((resolve, reject) => socket.on("open", resolve).on("error", reject));
  socket.off("error", socket.listeners("error")[0]).on("error", () => {});  // the studio may end before it
  const find = (fits) =>
    new Promise((resolve, reject) => {
      const giveUp = () => reject(new Error(`never told: ${fits}; but: ${told.map((each) => each.event ?? each.id).join(" ")}`));
      AbortSignal.timeout(kPatienceMs).addEventListener("abort", giveUp);
      const look = () => {
        const found = told.find(fits);
        if (found !== undefined) {
          waiting.delete(look);
          resolve(found);
        }
      };
      waiting.add(look);
      look();
    });
  let id = 0;
  const send = (command) => {
    socket.send(JSON.stringify({ id: ++id, ...command }));
    const own = id;
    return find((each) => each.id === own);
  };
  const hasOpened = () => find((each) => each.event === "scene" || each.has_scene === true);
  return { find, send, hasOpened };
}

/** Pages of one link are the same browser for the studio, whatever they are for the test. */
async function shareCookie(context, link) {
  const { origin, hash } = new URL(link);
  if (/^#t=[^&]+$/.test(hash)) {
    const { cookie } = await signIn(link);
    const [name, value] = cookie.split("=");
    await context.addCookies([{ name, value, url: origin, httpOnly: true, sameSite: "Strict" }]);
  }
}

/** Runs a test with a function that starts studios; those that have not ended by its end, as it failed, are killed. */
export function withStudios(run) {
  return async () => {
    const studios = [];
    const start = async (...args) => {
      studios.push(await startStudio(...args));
      return studios.at(-1);
    };
    try {
      await run(start);
    } finally {
      await Promise.all(studios.map((studio) => studio.kill()));
    }
  };
}

/** Runs a test with a studio, which ends with it. */
export function withStudio(args, run) {
  return withStudios(async (start) => {
    const studio = await start(args);
    await run(studio);
    assert.equal(await studio.stop(), 0, "it ends well when it is told to");
  });
}

/** For a group of tests that go on from one another: a studio that begins and ends with them. */
export function shareStudio(args) {
  const studio = {};
  before(async () => Object.assign(studio, await startStudio(args)));
  after(async () => assert.equal(await studio.stop(), 0, "it ends well when it is told to"));
  return studio;
}

/** Runs `hvas` to its end; what it prints. */
export function runProgram(args) {
  return execFileSync(kProgram, args, { encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
}

/** A copy of a file in a folder of its own, with what belongs to it beside it. */
export function copyToTemporary(files) {
  const folder = makeFolder();
  for (const file of files) {
    copyFileSync(file, join(folder, basename(file)));
  }
  return join(folder, basename(files[0]));
}

/** Without a graphics processor; smooth edges would make each picture take twice as long. */
export function launchBrowser({ isSmooth = false } = {}) {
  const kDrawing = ["--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
  const edges = isSmooth ? [] : ["--webgl-antialiasing-mode=none"];
  return chromium.launch({ executablePath: kChromium, args: ["--no-sandbox", ...kDrawing, ...edges] });
}

/** The browser of a file of tests that calls shareBrowser(). @type {import("playwright-core").Browser} */
export let browser;

/** Begins a browser before the tests of a file, and ends it with them. */
export function shareBrowser() {
  before(async () => {
    browser = await launchBrowser();
  });
  after(() => browser.close());
}

/** A page with a studio in it. `complaints`: what the browser has to say against it. `beforeLoad` gets the page
 before there is anything in it. `isPlain`: set up as by the user of a slow machine, small, without shadows and without
 motion that is not needed, for there is no graphics processor here. Tests that are about the picture have all of it.
 A stranger has not been there before: it comes by the link alone.
 @param {import("playwright-core").Browser} browser  Of a known type, so that the linter sees steps that nobody waits for. */
export async function openPage(browser, link, { beforeLoad = null, isPlain = true, isStranger = false, ...options } = {}) {
  const viewport = isPlain ? { width: 1024, height: 640 } : { width: 1280, height: 720 };
  const reducedMotion = isPlain ? "reduce" : "no-preference";
  const context = await browser.newContext({ viewport, reducedMotion, ...options });
  context.setDefaultTimeout(kPatienceMs);
  const page = await context.newPage();
  if (isPlain) {
    await page.addInitScript(prefer, { quality: "low", guidesFirstPart: false });
  }
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") {
      complaints.push(message.text());
    }
  });
  await beforeLoad?.(page);
  if (!isStranger) {
    await shareCookie(context, link);
  }
  await page.goto(link);
  return { page, complaints };
}

/** In the page, before anything else: what its user has set up before. */
function prefer(preferences) {
  const kKey = "hvas-studio";  // of app/preferences.ts
  if (localStorage.getItem(kKey) === null) {
    localStorage.setItem(kKey, JSON.stringify(preferences));
  }
}

/** Until this much of a scene has been drawn, with all parts: on a slow machine a product is shown as soon as its
 first parts are prepared, and what is pressed on while the others take their places is not what was aimed at. */
export async function waitForPicture(page, frames = 3) {
  const end = Date.now() + kPatienceMs;
  const isWhole = async () => {
    const { epoch } = await stateOf(page);
    const scene = await fetchScene(page);
    return scene.pending === 0 && scene.epoch === epoch;
  };
  do {
    await page.waitForFunction(
      (count) => window.hvas && window.hvas.state().hasScene && window.hvas.framesDrawn > count,
      frames,
      { timeout: end - Date.now() },
    );
    await nextFrame(page);
  } while (!(await isWhole()));
}

export function takePicture(page, name) {
  return page.screenshot({ path: join(kPictures, `${name}.png`) });
}

export function fetchScene(page) {
  return page.evaluate(async () => (await fetch("/api/scene")).json());
}

/** Until the page has been told that a part is there ("loose", "held", "placed"), and the server says so as well. */
export async function waitForPlacement(page, occurrence, placement, timeout = kPatienceMs) {
  const end = Date.now() + timeout;
  let found = "";
  while (Date.now() < end) {
    await waitForState(page, ({ placements }) => placements[occurrence] === placement, end - Date.now());
    found = (await fetchScene(page)).occurrences?.[occurrence].placement; // none while it is being changed
    if (found === placement) {
      return;
    }
    await nextFrame(page);
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

/** What axe has against the page as it is (WCAG 2.2 AA). */
export async function findBarriers(page) {
  if (!(await page.evaluate(() => "axe" in window))) {
    await page.evaluate(kAxe);  // as by the browser's own tools: the page's policy lets no script in
  }
  const kOptions = { runOnly: ["wcag2a", "wcag2aa", "wcag21aa", "wcag22aa"], resultTypes: ["violations"] };
  const found = await page.evaluate((options) => window.axe.run(document, options), kOptions);
  return found.violations.map((v) => `${v.id}: ${v.nodes[0]?.html}`);
}

/** What can be pressed or filled in and is not wholly on the screen, as far as it cannot be scrolled to; and whether the page
 is wider than its window. */
export function findOutside(page) {
  return page.evaluate(() => {
    const scrolls = (element) => /auto|scroll/.test(getComputedStyle(element).overflow);
    const isScrolled = (element) => element !== null && (scrolls(element) || isScrolled(element.parentElement));
    const all = [...document.querySelectorAll("button, a, input, select, [tabindex='0']")];
    const outside = all.filter((element) => {
      const { left, right, top, bottom, width, height } = element.getBoundingClientRect();
      const isIn = left >= -0.5 && top >= -0.5 && right <= innerWidth + 0.5 && bottom <= innerHeight + 0.5;
      return width > 0 && height > 0 && element.checkVisibility() && !isIn && !isScrolled(element.parentElement);
    });
    const wide = document.documentElement.scrollWidth > innerWidth ? ["the page is wider than its window"] : [];
    return [...wide, ...outside.map((element) => element.outerHTML.slice(0, 200))];
  });
}

/** How a page may be seen otherwise than by default, one after the other: in the colours of the system, and twice as large.
 @param page  One in German, as its words are the longest. */
export async function seeOtherwise(page, check) {
  const { width, height } = page.viewportSize();
  await check("German");
  await page.emulateMedia({ forcedColors: "active" });
  await check("forced colours");
  await page.emulateMedia({ forcedColors: "none" });
  await page.setViewportSize({ width: width / 2, height: height / 2 });
  await check("German at 200 %");
}

export function stateOf(page) {
  return page.evaluate(() => window.hvas.state());
}

/** Until what the page knows is so; returns it. It is asked once for each of its pictures. */
export async function waitForState(page, isSo, timeout = kPatienceMs) {
  const end = Date.now() + timeout;
  let state = await stateOf(page);
  while (!isSo(state)) {
    if (Date.now() > end) {
      throw new Error(`not so after ${timeout} ms: ${isSo}, but ${JSON.stringify(state)}`);
    }
    await nextFrame(page);
    state = await stateOf(page);
  }
  return state;
}

/** Until the page has had the time to draw so many pictures, whether it had anything to draw or not. What it has
 heard of before is seen after two: the one that was under way, and one more. */
export function nextFrame(page, count = 1) {
  return page.evaluate(
    (wanted) =>
      new Promise((resolve) => {
        let left = wanted;
        const step = () => (left-- > 0 ? requestAnimationFrame(step) : resolve());
        step();
      }),
    count,
  );
}

/** Until no transition of the page's style is under way, and the picture has followed it. */
export async function waitForCalm(page) {
  await nextFrame(page, 2);
  await page.evaluate(() => {
    const ends = document.getAnimations().filter((each) => each.effect.getComputedTiming().endTime !== Infinity);
    return Promise.allSettled(ends.map((each) => each.finished));
  });
  await nextFrame(page, 2);
}

/** From now on notes whether something is ever on the page, however short; returns a function that says so. */
export async function watchFor(page, selector) {
  const watch = await page.evaluateHandle((wanted) => {
    const noted = { isSeen: false };
    const look = () => (noted.isSeen ||= document.querySelector(wanted) !== null);
    new MutationObserver(look).observe(document.body, { childList: true, subtree: true, attributes: true });
    look();
    return noted;
  }, selector);
  return () => watch.evaluate(({ isSeen }) => isSeen);
}

/** Does something, and returns the text of the notice that it brings up, however short that is on the page. */
export async function noticeAfter(page, act) {
  const noted = await page.evaluateHandle(() => {
    const kept = { text: null };
    const look = () => (kept.text ??= document.querySelector("[data-testid=notice]")?.textContent ?? null);
    new MutationObserver(look).observe(document.body, { childList: true, subtree: true, characterData: true });
    return kept;
  });
  await act();
  await page.waitForFunction(({ text }) => text !== null, noted, { timeout: kPatienceMs });
  return noted.evaluate(({ text }) => text);
}

/** Until the server has answered all that the page has sent it so far: what that has led to is known by then. */
export function waitForAnswer(page) {
  return page.evaluate(() => window.hvas.hasAnswered());
}

/** After so long without an input the server takes the force away: PointerOperator::kSilentNs [ms]. */
export const kSilentMs = 250;

/** Until the session has gone on by so much [ms], as the page has seen it. */
export async function passSession(page, ms) {
  const from = await page.evaluate(() => window.hvas.sessionMs);
  await page.waitForFunction((to) => window.hvas.sessionMs >= to, from + ms);
}

/** A thing rests that is the same in so many pictures of the page, and for so long of the session [ms]: a hand that
 has been told to move on does so within a few milliseconds. */
const kStill = { frames: 4, sessionMs: 200, most: 1e-4 };

/** Until what is read stays the same, but for `most` in each of its numbers; returns it. Null is nothing to wait for.
 @param options.isOver  Whether it is of no interest any more: a session may end on the way. */
export async function waitForStill(page, read, options = {}, timeout = kPatienceMs) {
  const { frames, sessionMs, most, isOver } = { ...kStill, ...options };
  const end = Date.now() + timeout;
  const look = async () => ({ seen: await read(), at: await page.evaluate(() => window.hvas.sessionMs) });
  const numbers = (seen) => Object.values(seen).flat();
  const isSame = (a, b) => numbers(a).every((v, k) => Math.abs(v - numbers(b)[k]) <= most);
  let since = await look();
  let now = since;
  for (let count = 0; now.seen !== null && (count < frames || now.at - since.at < sessionMs); count++) {
    if (await isOver?.()) {
      break;
    }
    if (Date.now() > end) {
      throw new Error(`${JSON.stringify(now.seen)} is not at rest after ${timeout} ms; it was ${JSON.stringify(since.seen)}`);
    }
    await nextFrame(page);
    now = await look();
    if (now.seen !== null && !isSame(now.seen, since.seen)) {
      [since, count] = [now, -1];
    }
  }
  return now.seen;
}

/** Of a part, as the page draws it, in W. */
export function poseOf(page, occurrence) {
  return page.evaluate((id) => window.hvas.pose(id), occurrence);
}

/** Until a part lies, hangs or is held still, after all that the page was told to do; its pose. */
export async function waitForRest(page, occurrence, options = {}) {
  await nextFrame(page); // What the pointer did is sent by pictures.
  await waitForAnswer(page);
  return waitForStill(page, () => poseOf(page, occurrence), options);
}

/** Until the eye stands still: points beside each other are seen where they were, to a fraction of a pixel. */
export function waitForView(page) {
  const seen = () =>
    page.evaluate(() => {
      const points = [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]].map((p) => window.hvas.project(p));
      return points.flatMap(({ x, y }) => [x, y]);
    });
  return waitForStill(page, seen, { frames: 3, sessionMs: 0, most: 0.05 });
}

/** Between the origins of two poses [m]. */
export function distance(a, b) {
  return Math.hypot(...a.p.map((v, k) => v - b.p[k]));
}

/** Clicks where one sees this face of a part. */
async function clickFace(page, occurrence, face) {
  const at = await page.evaluate(([o, f]) => window.hvas.screenOfFace(o, f), [occurrence, face]);
  assert.ok(at, `face ${face} of part ${occurrence} is to be seen`);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.up();
}

/** Turns the view up or down by dragging beside the parts. */
export async function turnView(page, dy) {
  const { width, height } = page.viewportSize();
  const x = 0.92 * width;
  const y = (dy < 0 ? 0.8 : 0.18) * height;
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y + dy, { steps: 6 });
  await page.mouse.up();
  await waitForView(page);
}

/** The same by the arrow keys, which turn it where nothing is in the hand. */
export async function turnViewByKeys(page, dy) {
  await page.locator("canvas[role=application]").focus();
  await pressTimes(page, dy < 0 ? "ArrowDown" : "ArrowUp", 2);
  await waitForView(page);
}

/** Turns the view, first from below and then from above, until one sees a face of a part at rest; clicks it.
 @param moving  The part that a constraint may still be moving: it could hide the face a moment later. */
export async function findAndClickFace(page, occurrence, face, moving, turn = turnView) {
  const find = () => page.evaluate(([o, f]) => window.hvas.screenOfFace(o, f), [occurrence, face]);
  await waitForRest(page, moving);
  await waitForView(page);
  for (const dy of [...Array(6).fill(-60), ...Array(12).fill(60)]) {
    if ((await find()) !== null) {
      break;
    }
    await turn(page, dy);
  }
  await clickFace(page, occurrence, face);
}

/** Presses on a part and drags it a little: it is in the hand then. */
export async function takeByMouse(page, occurrence) {
  await waitForState(page, ({ leadsHand }) => leadsHand);  // who leads no hand takes nothing
  // The page brings the next part into its picture; it is pressed where it is seen when the button goes down.
  await page.waitForFunction((id) => window.hvas.screen(id)?.isVisible, occurrence);
  await waitForView(page);
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  assert.ok(at.isVisible, `part ${occurrence} is to be seen`);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + 8, at.y - 8, { steps: 3 });  // from here on it is no click
  await waitForPlacement(page, occurrence, "held");
}

/** Moves the mouse to where a point of W is seen; it is told of on the way as well, as that of a person. */
async function moveMouseTo(page, p_W) {
  const to = await page.evaluate((p) => window.hvas.project(p), p_W);
  await page.mouse.move(to.x, to.y, { steps: 6 });
}

/** Selects a part that is in its place, and draws it out upwards; the button stays down. */
export async function takeOutByMouse(page, occurrence, goal, height = 0.12) {
  await waitForRest(page, occurrence);
  await waitForView(page);
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  await page.mouse.click(at.x, at.y);
  await page.waitForFunction((id) => window.hvas.state().selected.includes(id), occurrence);
  await takeByMouse(page, occurrence);  // a press of its own: the browser is told which one is the second of a double click
  const [low, high] = await page.evaluate(
    ([[x, y, z], up]) => [window.hvas.project([x, y, z]), window.hvas.project([x, y, z + up])],
    [goal, height],
  );
  await page.mouse.move(at.x + high.x - low.x, at.y + high.y - low.y, { steps: 12 });
  await waitForRest(page, occurrence);
}

/** Takes hold of a part with the mouse and moves it over its place and in, as far as it goes; the button stays down. */
export async function insertByMouse(page, occurrence, goal, height = 0.12) {
  await takeByMouse(page, occurrence);
  await bringInByMouse(page, occurrence, goal, height);
}

/** Takes over with the mouse what is in a hand of this page already; the button stays down. */
export async function takeOverByMouse(page, occurrence) {
  await waitForView(page);
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  assert.ok(at.isVisible, `part ${occurrence} is to be seen`);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + 8, at.y - 8, { steps: 3 });
}

/** Moves the part under the mouse over its place and in, as far as it goes; the button stays down. */
export async function bringInByMouse(page, occurrence, goal, height = 0.12) {
  await moveMouseTo(page, [goal[0], goal[1], goal[2] + height]);
  await waitForRest(page, occurrence);
  const before = (await stateOf(page)).leaders[occurrence];
  await moveMouseTo(page, [goal[0], goal[1], goal[2] - 0.01]);
  // What is seated is let go after a while: it is in its place then, or one with the part on the table that has it.
  await waitForState(page, ({ held, placements, leaders }) =>
    held[0]?.state === "seated" || placements[occurrence] === "placed" || leaders[occurrence] !== before);
}

/** Goes on with Tab until the focus is there; a selector. */
export async function tabTo(page, selector) {
  for (let count = 0; count < 120; count++) {
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted) === true, selector)) {
      return;
    }
    await page.keyboard.press("Tab");
  }
  throw new Error(`Tab does not lead to ${selector}`);
}

export const tabToPicture = (page) => tabTo(page, "canvas[role=application]");

export async function pressTimes(page, key, count) {
  for (let k = 0; k < count; k++) {
    await page.keyboard.press(key);
  }
}
