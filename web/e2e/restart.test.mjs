// The studio ends without a word, and is started again: the work goes on, and nobody has to do anything for it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, it } from "node:test";
import {
  browser,
  connect,
  fetchScene,
  makeFolder,
  openPage,
  shareBrowser,
  signIn,
  stateOf,
  takePicture,
  waitForKept,
  waitForPicture,
  waitForPlacement,
  waitForState,
  withStudios,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kBushingPart = 1;

async function sceneOf({ origin, cookie }) {
  const answer = await fetch(`${origin}/api/scene`, { headers: { Cookie: cookie } });
  assert.equal(answer.status, 200);
  return answer.json();
}

describe("a studio that was killed", () => {
  it("has the same address, knows whoever was in, and goes on with parts, mates and fixture", withStudios(async (start) => {
    const home = makeFolder();
    const first = await start([kBushing], { home });
    const session = await signIn(first.operator);
    const client = await connect(session);
    await client.hasOpened();
    await client.send({ command: "assign_fit", mate: 0, fit: "H7/f7" });
    await client.find((each) => each.event === "scene" && each.why !== null);
    await client.send({ command: "next" });
    await client.find((each) => each.event === "demo" && !each.on);
    const before = await sceneOf(session);
    assert.equal(before.occurrences[kBushingPart].placement, "placed");
    await waitForKept(home, (work) => work.parts[kBushingPart].placement === "placed" && work.next_step === before.next_step);
    await first.kill();

    const second = await start([kBushing], { home });
    assert.equal(second.operator, first.operator);
    assert.equal(second.viewer, first.viewer);
    const again = await connect(session);
    const resumed = await again.find((each) => each.event === "resumed");
    assert.deepEqual([resumed.is_resumed, resumed.edits], [true, 1]);
    const now = await sceneOf(session);
    const state = ({ occurrences, mates, next_step }) => ({
      placements: occurrences.map((each) => each.placement),
      fits: mates.map((each) => each.fit?.code ?? null),
      next_step,
    });
    assert.deepEqual(state(now), state(before));
    assert.equal(now.mates[0].fit.code, "H7/f7");
    assert.notEqual(now.epoch, before.epoch, "pages know it from the scene before");
    const stranger = await fetch(`${second.origin}/api/session`, {
      method: "POST",
      headers: { Origin: second.origin },
      body: JSON.stringify({ token: new URL(second.operator).hash.slice("#t=".length) }),
    });
    assert.equal(stranger.status, 401, "the link has let a browser in, and lets in no other");
    assert.equal(await second.stop(), 0);

    const third = await start([kBushing, "--fresh", "--new-links"], { home });
    assert.notEqual(third.operator, first.operator);
    const anew = await signIn(third.operator);
    const newcomer = await connect(anew);
    await newcomer.hasOpened();
    const fresh = await sceneOf(anew);
    assert.equal(fresh.occurrences[kBushingPart].placement, "loose");
    assert.notEqual(fresh.mates[0].fit.code, "H7/f7");
    assert.equal(await third.stop(), 0);
  }));

  it("goes on with a file that was sent to it", withStudios(async (start) => {
    const home = makeFolder();
    const first = await start([], { home });
    const session = await signIn(first.operator);
    const client = await connect(session);
    const sent = await fetch(`${first.origin}/api/upload?name=mine.step`, {
      method: "POST",
      headers: { Origin: session.origin, Cookie: session.cookie },
      body: readFileSync(kBushing),
    });
    const { upload } = await sent.json();
    await client.send({ command: "open", upload });
    await client.find((each) => each.event === "step" && each.index > 0);
    const before = await sceneOf(session);
    await waitForKept(home, (work) => work.name === "mine.step");
    await first.kill();
    const second = await start([], { home });
    const again = await connect(session);
    await again.find((each) => each.event === "resumed" && each.is_resumed);
    assert.equal((await sceneOf(session)).name, before.name);
    assert.equal(await second.stop(), 0);
  }));
});

describe("a page", () => {
  shareBrowser();

  it("comes back by itself, with the part in its place", withStudios(async (start) => {
    const home = makeFolder();
    const first = await start([kBushing], { home });
    const { page } = await openPage(browser, first.operator);
    await waitForPicture(page);
    await page.evaluate(() => document.activeElement?.blur());
    await page.keyboard.press("n");
    await waitForPlacement(page, kBushingPart, "placed");
    await waitForState(page, ({ demo }) => !demo);
    await waitForKept(home, (work) => work.parts[kBushingPart].placement === "placed");
    await first.kill();
    await waitForState(page, ({ link }) => link === "lost");
    await page.getByText(/trying again/i).first().waitFor();
    await takePicture(page, "restart_lost");

    const { epoch: epochBefore } = await stateOf(page);
    const second = await start([kBushing], { home });
    const { epoch } = await waitForState(
      page,
      ({ link, hasScene, placements, epoch: now }) =>
        link === "open" && hasScene && now !== null && now !== epochBefore && placements[kBushingPart] === "placed",
    );
    assert.equal(epoch, (await fetchScene(page)).epoch);
    await waitForState(page, ({ hasLease }) => hasLease);
    await page.getByRole("log").filter({ hasText: /is restored/ }).waitFor({ state: "attached" });
    await takePicture(page, "restart_back");
    await page.keyboard.press("n");  // the next part
    await waitForPlacement(page, 2, "placed");
    assert.equal(await second.stop(), 0);

    const third = await start([kBushing, "--new-links", "--port", new URL(first.origin).port], { home });
    await page.getByTestId("denied").waitFor();
    await takePicture(page, "restart_denied");
    assert.equal((await stateOf(page)).link, "denied");
    assert.equal(await third.stop(), 0);
    await page.context().close();
  }));
});
