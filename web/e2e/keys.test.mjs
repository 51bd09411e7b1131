// Keys: what Escape and the stop do, and where keys go.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  distance,
  findBarriers,
  openPage,
  pressTimes,
  shareBrowser,
  stateOf,
  tabTo,
  tabToPicture,
  takePicture,
  waitForCalm,
  waitForPicture,
  waitForPlacement,
  waitForRest,
  waitForState,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const [kSleeve, kShaft] = [1, 2];

shareBrowser();

describe("Escape", () => {
  it("closes search, panel, tool and selection, in this order and one at a time", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await page.getByTestId(`part-${kSleeve}`).click();
    await page.keyboard.press("m");
    await page.keyboard.press("x");
    await page.keyboard.press("b");
    await page.keyboard.press("/");
    await page.keyboard.type("sh");
    const open = async () => ({
      search: await page.getByTestId("tree-search").inputValue(),
      panels: (await page.getByTestId("explode-panel").count()) + (await page.getByTestId("section-panel").count()),
      tool: await page.getByTestId("measure-panel").count(),
      selected: (await stateOf(page)).selected,
    });
    const all = { search: "sh", panels: 2, tool: 1, selected: [kSleeve] };
    assert.deepEqual(await open(), all);
    const after = [
      { ...all, search: "" },
      { ...all, search: "", panels: 1 },
      { ...all, search: "", panels: 0 },
      { ...all, search: "", panels: 0, tool: 0 },
      { search: "", panels: 0, tool: 0, selected: [] },
      { search: "", panels: 0, tool: 0, selected: [] },
    ];
    for (const wanted of after) {
      await page.keyboard.press("Escape");
      assert.deepEqual(await open(), wanted);
    }
    assert.equal((await stateOf(page)).forcesOff, false);
    await page.context().close();
  }));

  it("takes the force away while one acts, and F8 always does", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const forcesOn = async () => {
      await page.getByTestId("forces-on").click();
      await waitForState(page, ({ forcesOff }) => !forcesOff);
    };
    await page.keyboard.press("x");
    await page.getByTestId(`part-${kShaft}`).click();
    await page.keyboard.press("g");
    await waitForPlacement(page, kShaft, "held");
    await pressTimes(page, "ArrowUp", 10);  // off the table, so that its weight is felt
    await waitForState(page, ({ hands }) => hands.length > 0 && Math.hypot(...hands[0].f_felt_W_n) > 0.1);
    await page.keyboard.press("Escape");
    await waitForState(page, ({ forcesOff }) => forcesOff);
    assert.equal(await page.getByTestId("section-panel").count(), 1, "that alone");
    await forcesOn();
    await page.keyboard.press("Escape");
    await page.getByTestId("section-panel").waitFor({ state: "detached" });
    assert.equal((await stateOf(page)).forcesOff, false);
    await page.getByTestId("tree-search").fill("x");
    await page.keyboard.press("F8");
    await waitForState(page, ({ forcesOff }) => forcesOff);
    await forcesOn();
    await page.keyboard.press("Control+k");
    await page.getByTestId("palette-input").waitFor();
    await page.keyboard.press("F8");
    await waitForState(page, ({ forcesOff }) => forcesOff);
    await page.context().close();
  }));
});

describe("keys", () => {
  it("move the part in the hand wherever the focus is, but in fields", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await page.getByTestId(`part-${kShaft}`).click();
    await page.keyboard.press("g");
    await waitForPlacement(page, kShaft, "held");
    await page.keyboard.press("PageUp");
    let before = await waitForRest(page, kShaft);
    for (const place of ["[role=tree]", "[data-testid=button-tool-measure]", "canvas[role=application]", ".menu-title"]) {
      await tabTo(page, place);
      await pressTimes(page, "ArrowUp", 3);
      const now = await waitForRest(page, kShaft);
      assert.ok(distance(now, before) > 1e-3, `with the focus on ${place}`);
      before = now;
    }
    await page.getByTestId("tree-search").focus();
    await pressTimes(page, "ArrowUp", 3);
    assert.ok(distance(await waitForRest(page, kShaft), before) < 1e-4, "a field has its own");
    await page.keyboard.press("Escape");
    await page.context().close();
  }));

  it("of one sign can be switched off, which stays", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    await page.keyboard.press("?");
    await page.getByTestId("single-keys").click();
    await waitForCalm(page);
    assert.deepEqual(await findBarriers(page), []);
    await takePicture(page, "single_keys_off");
    await page.keyboard.press("Escape");
    await page.reload();
    await waitForPicture(page);
    for (const key of ["x", "m", "?", "/", "u", "5", "g"]) {
      await page.keyboard.press(key);
    }
    assert.equal(await page.getByTestId("section-panel").count(), 0);
    assert.equal(await page.getByTestId("measure-panel").count(), 0);
    assert.equal(await page.getByTestId("shortcuts").count(), 0);
    assert.equal(await page.getByTestId("bench-panel").count(), 0);
    assert.deepEqual((await stateOf(page)).held, []);
    // What has more than one key, or no character, still works.
    await tabToPicture(page);
    await page.keyboard.press("Enter");
    await waitForState(page, ({ held }) => held.length === 1);
    await page.keyboard.press("F8");
    await waitForState(page, ({ forcesOff }) => forcesOff);
    await page.keyboard.press("Control+k");
    await page.getByTestId("palette-input").waitFor();
    await page.context().close();
  }));
});
