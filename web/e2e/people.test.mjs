// Three people at one studio: names, what they point to, notes, hands, and the end of it (docs/studio.md).
import assert from "node:assert/strict";
import { it } from "node:test";
import {
  browser,
  fetchScene,
  findBarriers,
  kPatienceMs,
  nextFrame,
  openPage,
  poseOf,
  shareBrowser,
  stateOf,
  takeByMouse,
  takePicture,
  turnViewByKeys,
  waitForPicture,
  waitForRest,
  waitForState,
  withStudio,
} from "./harness.mjs";

shareBrowser();

async function openShare(page) {
  if ((await page.getByTestId("share").count()) === 0) {
    await page.getByTestId("button-share").click();
  }
  await page.getByTestId("own-name").waitFor();
}

async function giveName(page, name) {
  await openShare(page);
  await page.getByTestId("own-name").fill(name);
  await page.getByTestId("own-name").press("Enter");
  await page.getByTestId("own-name").blur();
}

const closeDialog = (page) => page.keyboard.press("Escape");

async function inviteOperator(page) {
  await openShare(page);
  await page.getByTestId("share-operator").click();
  await page.waitForFunction(() => /#t=/.test(document.querySelector('[data-testid="share-link"]')?.value ?? ""));
  const link = await page.getByTestId("share-link").inputValue();
  await closeDialog(page);
  return link;
}

async function join(page, host, count) {
  await page.getByTestId("hint-join").click();
  await host.getByTestId("lease-asked").getByRole("button", { name: "Give" }).click();
  await waitForState(page, ({ hands }) => hands.length === count);
}

it("people see each other's names and pointers, follow a view, pin notes, and the host ends it", withStudio(["../products/bushing.step"], async (studio) => {
  const { page: host } = await openPage(browser, studio.operator);
  await waitForPicture(host);
  const { page: guest } = await openPage(browser, await inviteOperator(host), { isStranger: true });
  await waitForPicture(guest);
  await giveName(guest, "Ada");
  await closeDialog(guest);
  await openShare(host);
  const ada = host.getByTestId("person-c2");
  await ada.getByText("Ada").waitFor();
  await host.getByText("helps").or(host.getByText("looks on")).first().waitFor();
  assert.deepEqual(await findBarriers(host), []);
  await takePicture(host, "people_list");
  await closeDialog(host);

  // What the guest points to is marked in the host's picture, with the name.
  const scene = await fetchScene(host);
  const part = scene.occurrences.find(({ is_base: isBase }) => !isBase).id;
  const at = await guest.evaluate((id) => window.hvas.screen(id), part);
  await guest.mouse.move(at.x, at.y, { steps: 3 });
  const cursor = host.getByTestId("cursor-c2");
  await cursor.waitFor();
  assert.equal(await cursor.innerText(), "Ada");
  const wanted = await host.evaluate((id) => window.hvas.screen(id), part);
  const box = await cursor.boundingBox();
  assert.ok(Math.hypot(box.x - wanted.x, box.y - wanted.y) < 40, `the mark is at ${box.x}, ${box.y}, the part at ${wanted.x}, ${wanted.y}`);
  await takePicture(host, "people_cursor");

  // The host follows the guest's view until the own one is moved.
  await openShare(host);
  await host.getByTestId("follow-c2").click();
  await closeDialog(host);
  await guest.evaluate(() => document.activeElement?.blur());
  await guest.keyboard.press("5");
  const eyeOf = async (page) => (await stateOf(page)).eye;
  await host.getByTestId("followed").waitFor();
  const start = Date.now();
  for (;;) {
    const [a, b] = [await eyeOf(host), await eyeOf(guest)];
    if (Math.hypot(...a.map((v, k) => v - b[k])) < 1e-3) {
      break;
    }
    assert.ok(Date.now() - start < kPatienceMs, `the views differ: ${a} and ${b}`);
    await nextFrame(host);
  }
  await turnViewByKeys(host, 40);
  await host.getByTestId("followed").waitFor({ state: "detached" });

  // A note of the guest is on the part that was clicked, for all.
  const spot = await guest.evaluate((id) => window.hvas.screen(id), part);
  await guest.mouse.click(spot.x, spot.y);
  await guest.mouse.click(spot.x, spot.y, { button: "right" });
  await guest.getByRole("menuitem", { name: "Pin a note" }).click();
  await guest.getByTestId("note-text").fill("Deburr <b>this</b> edge");
  await guest.getByTestId("note-pin").click();
  const pin = host.locator('[data-testid^="note-n"]');
  await pin.waitFor();
  await pin.getByRole("button").click();
  await host.getByText("Deburr <b>this</b> edge").waitFor();
  await takePicture(host, "people_note");
  assert.deepEqual(await findBarriers(host), []);

  // The host ends the sharing: the guest is out, and does not come back by itself.
  await openShare(host);
  await host.getByTestId("end-sharing").click();
  await waitForState(guest, ({ link }) => link === "denied" || link === "lost");
  await waitForState(host, ({ clients }) => clients === 1);
  await guest.reload();
  await waitForState(guest, ({ link }) => link === "denied");
}));

it("three people have a hand each, hold one part by two, and then a part each", withStudio(["../products/snap_joint.step"], async (studio) => {
  const pages = [];
  for (let n = 0; n < 3; n++) {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    if (n > 0) {
      await join(page, pages[0], n + 1);
    }
    pages.push(page);
  }
  const scene = await fetchScene(pages[0]);
  const parts = scene.occurrences.filter(({ is_base: isBase }) => !isBase).slice(0, 3);
  // The second one takes hold of what the first one has: both feel it, until the second one lets go.
  await takeByMouse(pages[0], parts[0].id);
  await pages[0].mouse.up();
  await pages[1].getByTestId("hold-together").click();
  await waitForState(pages[2], ({ hands }) => hands[0].occurrence === parts[0].id && hands[1].occurrence === parts[0].id);
  await takePicture(pages[2], "two_people_hold");
  await pages[1].evaluate(() => document.activeElement?.blur());
  await pages[1].keyboard.press("r");
  await waitForState(pages[2], ({ hands }) => hands[0].occurrence === parts[0].id && hands[1].state === 0);

  for (const [n, page] of pages.entries()) {
    if (n === 0) {
      continue; // It holds a part already.
    }
    await takeByMouse(page, parts[n].id);
    await page.mouse.up();
    await waitForRest(page, parts[n].id);
  }
  await waitForState(pages[0], ({ held }) => held.length === 3);
  const seen = await Promise.all(pages.map((page) => poseOf(page, parts[2].id)));
  assert.ok(seen.every(({ p }) => Math.hypot(...p.map((v, k) => v - seen[2].p[k])) < 1e-3), "all see the third part in one place");
  await takePicture(pages[0], "three_people");
}));
