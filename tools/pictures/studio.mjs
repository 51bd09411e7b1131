// Pictures of the studio for the documents, by headless Chromium: desk.png, a shaft that is put in by mouse; studio.png,
// the simulated person at work; assembly.webp, the whole gear pump put together, as a moving picture.
// Run by tools/pictures/make, in web/ (for its packages), with HVAS_BINARY. OUT [SECONDS [NAME]]: the folder, how many
// seconds of the assembly are recorded at most, for a quick try, and "desk" or "pump" where only that is wanted.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import {
  connect,
  fetchScene,
  insertByMouse,
  launchBrowser,
  makeFolder,
  nextFrame,
  openPage,
  signIn,
  startStudio,
  takeByMouse,
  waitForCalm,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
} from "../../web/e2e/harness.mjs";

const [out, longest = "600", only = ""] = process.argv.slice(2);
const kProducts = new URL("../../products/", import.meta.url).pathname;
const kSize = { width: 1120, height: 690 };
const kDeskSize = { width: 1360, height: 760 };
const kScale = 0.7;         // of the moving picture
const kMostBytes = 2e6;     // of the moving picture
const kQuality = 0.7;       // of its frames, lossy WebP
const kBlock = 16;          // Edge of what is drawn again where anything has changed [pixels]
const kSlowPart = { untilS: 34, stepS: 1, shownMs: 200 };  // the first parts, so that one sees how a part goes in
const kFastPart = { stepS: 3, shownMs: 140 };  // the others
const kEndMs = 3000;  // for which the finished pump is shown
const kPng = { step: 7 };  // of studio.png: the first part from this step on that a mate guides
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** One chunk of a RIFF file: padded to an even size. */
function chunk(name, ...parts) {
  const body = Buffer.concat(parts);
  const head = Buffer.alloc(8);
  head.write(name, 0, "latin1");
  head.writeUInt32LE(body.length, 4);
  return Buffer.concat([head, body, Buffer.alloc(body.length % 2)]);
}

const u24 = (value) => Buffer.from([value & 255, (value >> 8) & 255, (value >> 16) & 255]);

/** The chunks of a still picture that a frame of a moving one has as well. */
function readStill(file) {
  const chunks = [];
  for (let at = 12; at + 8 <= file.length;) {
    const name = file.toString("latin1", at, at + 4);
    const size = file.readUInt32LE(at + 4);
    if (["ALPH", "VP8 ", "VP8L"].includes(name)) {
      chunks.push(chunk(name, file.subarray(at + 8, at + 8 + size)));
    }
    at += 8 + size + (size % 2);
  }
  return Buffer.concat(chunks);
}

/** An animated WebP (RFC 9649, section 2.7) that begins anew when it has ended. What is transparent in a frame stays
 as the frames before have left it. */
function animate(frames, { width, height }) {
  const size = Buffer.concat([u24(width - 1), u24(height - 1)]);
  const body = Buffer.concat([
    Buffer.from("WEBP", "latin1"),
    chunk("VP8X", Buffer.from([0x12, 0, 0, 0]), size),
    chunk("ANIM", Buffer.from([255, 255, 255, 255, 0, 0])),
    ...frames.map(({ file, shownMs }) => chunk("ANMF", u24(0), u24(0), size, u24(shownMs), Buffer.from([0]), readStill(file))),
  ]);
  const head = Buffer.alloc(8);
  head.write("RIFF", 0, "latin1");
  head.writeUInt32LE(body.length, 4);
  return Buffer.concat([head, body]);
}

/** In a page: a picture (PNG, base64) as WebP, transparent in all blocks that are as in the picture before. */
async function encodeChanges({ png, quality, block }) {
  const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
  const { width, height } = bitmap;
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  const image = context.getImageData(0, 0, width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const before = globalThis.pixelsBefore;
  globalThis.pixelsBefore = pixels.slice();
  if (before !== undefined) {
    for (let y0 = 0; y0 < height; y0 += block) {
      for (let x0 = 0; x0 < width; x0 += block) {
        const [x1, y1] = [Math.min(x0 + block, width), Math.min(y0 + block, height)];
        let isSame = true;
        for (let y = y0; y < y1 && isSame; y++) {
          for (let x = x0; x < x1 && isSame; x++) {
            isSame = pixels[y * width + x] === before[y * width + x];
          }
        }
        for (let y = y0; y < y1 && isSame; y++) {
          pixels.fill(0, y * width + x0, y * width + x1);
        }
      }
    }
  }
  context.putImageData(image, 0, 0);
  const blob = await canvas.convertToBlob({ type: "image/webp", quality });
  const bytes = new Uint8Array(await blob.arrayBuffer());
  return { width, height, base64: btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")) };
}

/** Starts a studio with a product, and ends it with what is done there. */
async function withStudio(product, run) {
  const folder = makeFolder();
  const studio = await startStudio([join(kProducts, product), "--fresh", "--recordings", folder, "-q"], { home: folder, clock: "machine" });
  const browser = await launchBrowser();
  try {
    await run(studio, browser);
  } finally {
    await browser.close();
    await studio.kill();
  }
}

/** The shaft on its way into the bushing, by mouse. */
async function takeDesk(studio, browser) {
  const { page } = await openPage(browser, studio.operator, { isPlain: false, viewport: kDeskSize });
  await waitForPicture(page);
  const scene = await fetchScene(page);
  const [first, second] = scene.steps.filter((step) => step.kind === "insert").map((step) => step.occurrence);
  await insertByMouse(page, first, scene.occurrences[first].goal.p);
  await page.mouse.up();
  await waitForPlacement(page, first, "placed");
  const [x, y, z] = scene.occurrences[second].goal.p;
  await takeByMouse(page, second);
  const heights = [0.12];
  for (let k = 1; k <= 60; k++) {
    heights.push(0.12 - 0.002 * k);
  }
  for (const height of heights) {
    const to = await page.evaluate((p) => window.hvas.project(p), [x, y, z + height]);
    await page.mouse.move(to.x, to.y, { steps: 3 });
    if (height === heights[0]) {
      await waitForRest(page, second);
    }
    await nextFrame(page, 2);
    const state = await page.evaluate(() => window.hvas.state());
    if (state.held[0]?.state === "mating" && (state.hands[0]?.depth_m ?? 0) > 0.01) {
      break;
    }
  }
  await waitForCalm(page);
  await page.screenshot({ path: join(out, "desk.png") });
}

/** The pump: a moment of the simulated person's work, and all of it. */
async function takePump(studio, browser) {
  const session = await signIn(studio.operator);
  const { find, send: ask, hasOpened } = await connect(session);
  const send = async (command) => {
    const answer = await ask(command);
    assert.ok(answer.ok, JSON.stringify([command, answer.error]));
    return answer.result;
  };
  /** Until this client has the hand: a page that has gone has it for a moment longer. */
  const takeHand = async () => {
    while ("waits_for" in (await send({ command: "lease", action: "request" }))) {
      await pause(200);
    }
  };
  await hasOpened();
  await takeHand();
  const getJson = async (route) => (await fetch(session.origin + route, { headers: { Cookie: session.cookie } })).json();
  const { centre_m: centre, occurrences } = await getJson("/api/scene");
  const eye = [0.34, -0.62, 0.42].map((v, k) => v + centre[k]);
  const target = [0.1, -0.02, -0.07].map((v, k) => v + centre[k]);
  const shown = `view&eye=${eye.map((v) => v.toFixed(4))}&to=${target.map((v) => v.toFixed(4))}`;

  await send({ command: "record", on: true, name: "gear pump" });
  await send({ command: "demo", on: true });
  const began = Date.now();

  /** Lets a page have the hand, as that of somebody who steers has it. */
  const giveHand = async () => {
    const { clients } = await find((each) => each.event === "roles" && each.clients.length > 1);
    const page = clients.find((each) => !each.has_lease && each.role === "operator");
    await send({ command: "lease", action: "give", to: page.id });
  };

  // The live picture, of a page that goes again before the rest is recorded.
  const [name, value] = session.cookie.split("=");
  const cookie = { name, value, url: session.origin, httpOnly: true, sameSite: "Strict" };
  const beforeLoad = (page) => page.context().addCookies([cookie]);  // the link lets in one browser, and this script was first
  const options = { isPlain: false, viewport: kSize, beforeLoad };
  const live = (await openPage(browser, `${studio.operator}&${shown}`, options)).page;
  await waitForPicture(live);
  await giveHand();
  await waitForState(live, (state) => (state.step?.index ?? 0) >= kPng.step && (state.held[0]?.state ?? "") === "mating", 180_000);
  await waitForCalm(live);
  await live.screenshot({ path: join(out, "studio.png") });
  await Promise.race([live.context().close(), pause(20_000)]);  // a browser without a graphics processor may be long about it
  await takeHand();

  const isDone = async () => (await getJson("/api/scene")).occurrences.every((each) => each.placement === "placed");
  process.stderr.write("studio.png is taken; the rest of the pump is put together\n");
  while (Date.now() - began < 1000 * Number(longest) && !(await isDone())) {
    await pause(1000);
  }
  await ask({ command: "demo", on: false });  // it may have ended by itself
  await send({ command: "record", on: false });
  const listed = async () => (await getJson("/api/recordings")).recordings.find((each) => each.is_complete);
  while ((await listed()) === undefined) {
    await pause(200);
  }
  const recording = await listed();
  process.stderr.write(`recorded ${recording.duration_s.toFixed(0)} s of ${occurrences.length} parts\n`);

  const link = `${studio.operator}&${shown}&rec=${encodeURIComponent(recording.id)}&at=0`;
  const { page } = await openPage(browser, link, { ...options, deviceScaleFactor: kScale });
  await waitForState(page, (state) => state.hasScene && state.playback !== null, 60_000);
  await waitForPicture(page);
  const { durationS } = (await page.evaluate(() => window.hvas.state())).playback;
  await page.getByTestId("timeline").focus();
  await page.keyboard.press("Home");
  const encoder = await browser.newPage();
  const size = {};
  const capture = async () => {
    const png = (await page.screenshot({ timeout: 180_000 })).toString("base64");
    const { base64, width, height } = await encoder.evaluate(encodeChanges, { png, quality: kQuality, block: kBlock });
    Object.assign(size, { width, height });
    return Buffer.from(base64, "base64");
  };
  const frames = [];
  for (let atS = 0; ;) {
    await nextFrame(page, 3);
    const isSlow = atS < kSlowPart.untilS;
    frames.push({ file: await capture(), shownMs: (isSlow ? kSlowPart : kFastPart).shownMs });
    if (atS >= durationS) {
      break;
    }
    const stepS = (isSlow ? kSlowPart : kFastPart).stepS;
    for (let k = 0; k < stepS; k++) {
      await page.keyboard.press("PageUp");
    }
    atS += stepS;
  }
  await encoder.close();
  frames.at(-1).shownMs = kEndMs;
  const picture = animate(frames, size);
  writeFileSync(join(out, "assembly.webp"), picture);
  process.stderr.write(`${frames.length} frames, ${(picture.length / 1e6).toFixed(2)} MB\n`);
  if (picture.length > kMostBytes) {
    throw new Error("the moving picture is too large: lower kQuality or kScale");
  }
}

mkdirSync(out, { recursive: true });
if (only !== "pump") {
  await withStudio("bushing.step", takeDesk);
}
if (only !== "desk") {
  await withStudio("gear_pump.step", takePump);
}
