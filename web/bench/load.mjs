// What a page that draws costs the hand, and how old its picture is: `npm run load [-- FILE]` with the program
// in HVAS_BINARY. A part is held and pressed on the table by a client that draws nothing; a page with the same
// product comes and goes beside it, turning the view all the time: once as a client of the same program, once of
// another one, which shows what the drawing alone takes of caches and cores. Figures are for docs/studio.md.
import { performance } from "node:perf_hooks";
import WebSocket from "ws";
import { launchBrowser, openPage, signIn, startStudio, waitForPicture } from "../e2e/harness.mjs";
import { quantile } from "./quantile.mjs";

const kRounds = 3;
const kWindowMs = 15_000;
const kSettleMs = 3_000;
const kCommandMs = 40; // between two whose way there and back is measured
const kPublishMs = 1000 / 60;
const kPressM = 0.004; // so far below where it lies

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** A client that steers and draws nothing. */
class Hand {
  #socket;
  #waiting = new Map();
  #lastId = 0;
  #pose = null;
  computeUs = [];
  roundTripMs = [];

  static async join(studio) {
    const { cookie } = await signIn(studio.operator);
    const hand = new Hand();
    hand.fetchScene = async () => (await fetch(`${studio.origin}/api/scene`, { headers: { Cookie: cookie } })).json();
    const url = `${studio.origin.replace("http", "ws")}/ws`;
    hand.#socket = new WebSocket(url, { origin: studio.origin, headers: { Cookie: cookie } });
    hand.#socket.on("message", (data, isBinary) => (isBinary ? null : hand.#hear(JSON.parse(data.toString()))));
    await new Promise((resolve) => hand.#socket.once("open", resolve));
    setInterval(() => hand.#press(), kPublishMs).unref();
    setInterval(() => void hand.ask({ command: "status" }), kCommandMs).unref();
    return hand;
  }

  ask(command) {
    const id = ++this.#lastId;
    const sentAt = performance.now();
    this.#socket.send(JSON.stringify({ id, ...command }));
    return new Promise((resolve) => this.#waiting.set(id, { resolve, sentAt }));
  }

  #hear(message) {
    if (message.event === "status") {
      this.computeUs.push(message.compute_p50_us);
    }
    const asked = this.#waiting.get(message.id);
    if (asked) {
      this.#waiting.delete(message.id);
      this.roundTripMs.push(performance.now() - asked.sentAt);
      asked.resolve(message);
    }
  }

  async take(occurrence) {
    const { result } = await this.ask({ command: "take", hand: 0, occurrence });
    this.#pose = result.hand;
    this.#pose.p[2] -= kPressM;
  }

  #press() {
    if (this.#pose === null) {
      return;
    }
    const kHeader = 32;
    const frame = Buffer.alloc(kHeader + 40);
    frame.write("HVAS", 0, "latin1");
    frame.writeUInt16LE(1, 4); // version
    frame.writeUInt16LE(16, 6); // Input
    frame.writeUInt32LE(frame.length, 8);
    frame.writeUInt32LE(1, 20); // one item
    frame.writeUInt32LE(1, kHeader + 4); // it grips
    [...this.#pose.p, ...this.#pose.q].forEach((v, k) => frame.writeFloatLE(v, kHeader + 8 + 4 * k));
    this.#socket.send(frame);
  }

  forget() {
    this.computeUs = [];
    this.roundTripMs = [];
  }
}

/** Turns the view for some time; ages and frame times of the picture as the page has them. */
async function drawFor(page, ms) {
  const box = await page.locator("canvas").first().boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 4];
  const samples = [];
  const end = performance.now() + ms;
  await page.mouse.move(x, y);
  await page.mouse.down({ button: "right" });
  for (let k = 0; performance.now() < end; k++) {
    await page.mouse.move(x + 80 * Math.sin(0.4 * k), y + 30 * Math.cos(0.4 * k));
    samples.push(await page.evaluate(() => {
      const { ageMs, framesPerSecond } = window.hvas.state();
      return { ageMs, frameMs: 1000 / framesPerSecond };
    }));
  }
  await page.mouse.up({ button: "right" });
  return samples.filter((sample) => sample.ageMs !== null && Number.isFinite(sample.frameMs));
}

/** What the hand sees of a page that draws, from when it has settled. */
async function drawWith(browser, studio, hand) {
  const { page } = await openPage(browser, studio.operator);
  await waitForPicture(page);
  await sleep(kSettleMs);
  hand.forget();
  const samples = await drawFor(page, kWindowMs);
  await page.context().close();
  return samples;
}

async function measure(file) {
  const studio = await startStudio([file], { clock: "machine" });
  const other = await startStudio([file], { clock: "machine" });
  const browser = await launchBrowser();
  const figures = { alone: [], beside: [], drawing: [], roundTripMs: [], samples: [] };
  try {
    const hand = await Hand.join(studio);
    let scene = await hand.fetchScene();
    for (; scene.occurrences === undefined; scene = await hand.fetchScene()) {
      await sleep(500);
    }
    await hand.take(scene.steps.find((step) => step.kind === "insert" && step.members.length === 0).occurrence);
    for (let round = 0; round < kRounds; round++) {
      await sleep(kSettleMs);
      hand.forget();
      await sleep(kWindowMs);
      figures.alone.push(...hand.computeUs);
      await drawWith(browser, other, hand);
      figures.beside.push(...hand.computeUs);
      figures.samples.push(...(await drawWith(browser, studio, hand)));
      figures.drawing.push(...hand.computeUs);
      figures.roundTripMs.push(...hand.roundTripMs);
    }
    return { parts: scene.occurrences.length, triangles: scene.triangles, ...figures };
  } finally {
    await browser.close();
    await other.stop();
    await studio.stop();
  }
}

const found = await measure(process.argv[2] ?? "../products/frame_500.step");
const alone = quantile(found.alone, 0.5);
const beside = quantile(found.beside, 0.5);
const drawing = quantile(found.drawing, 0.5);
const inFrames = found.samples.map((sample) => sample.ageMs / sample.frameMs);
const report = {
  parts: found.parts,
  triangles: found.triangles,
  compute_alone_us: alone,
  compute_drawing_us: drawing,
  compute_beside_us: beside,
  compute_ratio_to_alone: drawing / alone,
  compute_ratio_to_beside: drawing / beside,
  frames_per_second: 1000 / quantile(found.samples.map((sample) => sample.frameMs), 0.5),
  age_ms_p50: quantile(found.samples.map((sample) => sample.ageMs), 0.5),
  age_ms_p99: quantile(found.samples.map((sample) => sample.ageMs), 0.99),
  age_frames_p50: quantile(inFrames, 0.5),
  age_frames_p99: quantile(inFrames, 0.99),
  round_trip_ms_p50: quantile(found.roundTripMs, 0.5),
  round_trip_ms_p99: quantile(found.roundTripMs, 0.99),
  publish_ms: kPublishMs,
};
console.log(JSON.stringify(report, null, 2));
