// The studio on a phone and a tablet, by touch: the forces can be taken away in every state, a part is put in with one
// finger and turned with two, and axe finds nothing (WCAG 2.2 AA).
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  fetchScene,
  findBarriers,
  findOutside,
  openPage,
  poseOf,
  seeOtherwise,
  shareBrowser,
  stateOf,
  takePicture,
  waitForCalm,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  waitForStill,
  waitForView,
  withStudio,
} from "./harness.mjs";

shareBrowser();

const kBushing = "../products/bushing.step";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
const kScreens = {
  phone: kPhone,
  "phone that lies": { ...kPhone, viewport: { width: 844, height: 390 } },
  tablet: { ...kPhone, viewport: { width: 820, height: 1180 } },
};
const kDialogs = ["shortcuts", "devices", "recordings", "views", "share"];

/** Whether a press in the middle of the button reaches it, wherever in the picture it is. */
function reachesForcesOff(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll("[data-testid=forces-off]")].some((button) => {
      const { left, right, top, bottom } = button.getBoundingClientRect();
      const isInside = left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
      return isInside && button.contains(document.elementFromPoint((left + right) / 2, (top + bottom) / 2));
    }),
  );
}

/** Fingers, as the browser gets them from a screen. */
async function makeFingers(page) {
  const session = await page.context().newCDPSession(page);
  const send = (type, points) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(({ x, y }, id) => ({ x, y, id })) });
  const at = [];
  return {
    async down(point) {
      at.push({ ...point });
      await send("touchStart", at);
    },
    /** All of them to where they are to be, in some steps. */
    async move(to, steps = 8) {
      const from = at.map((point) => ({ ...point }));
      for (let k = 1; k <= steps; k++) {
        at.forEach((point, i) => {
          point.x = from[i].x + ((to[i].x - from[i].x) * k) / steps;
          point.y = from[i].y + ((to[i].y - from[i].y) * k) / steps;
        });
        await send("touchMove", at);
      }
    },
    async up() {
      at.pop();
      await send("touchEnd", at);
    },
  };
}

const project = (page, p) => page.evaluate((point) => window.hvas.project(point), p);

async function takeByTouch(page, fingers, occurrence) {
  await waitForState(page, ({ hasLease }) => hasLease);
  await waitForView(page);
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  assert.ok(at.isVisible, `part ${occurrence} is to be seen`);
  await fingers.down(at);
  await fingers.move([{ x: at.x, y: at.y - 12 }], 3);
  await waitForPlacement(page, occurrence, "held");
}

describe("on a screen that is touched", () => {
  for (const [name, options] of Object.entries(kScreens)) {
    it(`${name}: forces off is in reach in every state, and axe finds nothing`, withStudio([kBushing], async (studio) => {
      const { page, complaints } = await openPage(browser, studio.operator, options);
      await waitForPicture(page);
      for (const colorScheme of ["light", "dark"]) {
        await page.emulateMedia({ colorScheme });
        await waitForCalm(page);
        assert.ok(await reachesForcesOff(page), "at first");
        assert.deepEqual(await findBarriers(page), []);
        const sheets = name === "tablet" ? [] : ["steps", "parts", "plots"];
        for (const sheet of sheets) {
          await page.getByTestId(`phone-${sheet}`).tap();
          await waitForCalm(page);
          assert.ok(await reachesForcesOff(page), `the sheet of ${sheet}`);
          assert.deepEqual(await findBarriers(page), [], sheet);
          await takePicture(page, `${name.replaceAll(" ", "_")}_${sheet}_${colorScheme}`);
          await page.getByTestId(`phone-${sheet}`).tap();
        }
        if (sheets.length > 0) {
          await page.getByTestId("phone-menu").tap();
          await waitForCalm(page);
          assert.ok(await reachesForcesOff(page), "the menu");
          await page.getByTestId("phone-menu").tap();
          for (const dialog of kDialogs) {
            await page.getByTestId("phone-menu").tap();
            await page.getByTestId(`menu-${dialog}`).tap();
            await waitForCalm(page);
            assert.ok(await reachesForcesOff(page), dialog);
            await page.keyboard.press("Escape");
            await waitForCalm(page);
          }
        }
      }
      assert.deepEqual(complaints, []);
      await page.context().close();
    }));
  }

  for (const [name, options] of Object.entries(kScreens)) {
    it(`${name}: in German, in forced colours and at 200 % nothing is out of the screen, and axe finds nothing`, withStudio([kBushing], async (studio) => {
      const { page, complaints } = await openPage(browser, studio.viewer, { ...options, locale: "de-DE" });
      await waitForPicture(page);
      await seeOtherwise(page, async (way) => {
        const check = async (state) => {
          await waitForCalm(page);
          assert.deepEqual(await findBarriers(page), [], `${way}: ${state}`);
          assert.deepEqual(await findOutside(page), [], `${way}: ${state}`);
          assert.ok(await reachesForcesOff(page), `${way}: ${state}`);
          await takePicture(page, `${name}_${way}_${state}`.replaceAll(/[ %]+/g, "_"));
        };
        await check("first");
        for (const sheet of (await page.getByTestId("phone-menu").count()) > 0 ? ["steps", "parts", "plots"] : []) {
          await page.getByTestId(`phone-${sheet}`).tap();
          await check(sheet);
          await page.getByTestId(`phone-${sheet}`).tap();
        }
      });
      assert.deepEqual(complaints, []);
      await page.context().close();
    }));
  }

  it("phone: the first part is put in with one finger, in less than 90 s of the session", withStudio([kBushing], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator, kPhone);
    await waitForPicture(page);
    const scene = await fetchScene(page);
    const { occurrence } = scene.steps.find(({ kind }) => kind === "insert");
    const [x, y, z] = scene.occurrences[occurrence].goal.p;
    const fingers = await makeFingers(page);
    await takeByTouch(page, fingers, occurrence);
    await takePicture(page, "phone_carrying");
    await fingers.move([await project(page, [x, y, z + 0.12])]);
    await waitForStill(page, async () => ({ p: (await poseOf(page, occurrence)).p }));
    await fingers.move([await project(page, [x, y, z - 0.01])]);
    await waitForState(page, ({ held, placements }) => held[0]?.state === "seated" || placements[occurrence] === "placed");
    await fingers.up();
    const ms = await page.evaluate(() => window.hvas.sessionMs);
    assert.ok(ms < 90_000, `${ms} ms`);
    await takePicture(page, "phone_seated");
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("phone: two fingers turn a part that is held, and move it along the line of sight", withStudio([kBushing], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator, kPhone);
    await waitForPicture(page);
    const scene = await fetchScene(page);
    const { occurrence } = scene.steps.find(({ kind }) => kind === "insert");
    const fingers = await makeFingers(page);
    await takeByTouch(page, fingers, occurrence);
    const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
    await fingers.move([{ x: at.x, y: at.y - 120 }]);
    const before = await waitForRest(page, occurrence);
    const first = { x: at.x, y: at.y - 120 };
    await fingers.down({ x: first.x, y: first.y + 80 });
    await fingers.move([first, { x: first.x + 80, y: first.y }]);  // a quarter turn
    const turned = await waitForRest(page, occurrence);
    const dot = Math.abs(before.q.reduce((sum, value, k) => sum + value * turned.q[k], 0));
    assert.ok(2 * Math.acos(Math.min(1, dot)) > 0.5, "it has turned");
    await fingers.move([first, { x: first.x + 40, y: first.y }]);
    const pushed = await waitForRest(page, occurrence);
    assert.ok(Math.hypot(...pushed.p.map((value, k) => value - turned.p[k])) > 0.003, "it has gone away from the eye");
    await fingers.up();
    await fingers.up();
    assert.equal((await stateOf(page)).held[0]?.occurrence, occurrence, "it stays in the hand");
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));
});
