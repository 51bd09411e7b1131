// What makes the work easier, and that everybody can use it: in each of its states the page has nothing
// that axe finds (WCAG 2.2 AA).
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  findBarriers,
  openPage,
  shareBrowser,
  takePicture,
  waitForCalm,
  waitForPicture,
  waitForState,
  waitForStill,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";

shareBrowser();

/** A key that opens something and closes it again; what is seen then. */
const toggle = (key, seen) => ({
  seen,
  open: (page) => page.keyboard.press(key),
  close: (page) => page.keyboard.press(key),
});
/** What Escape closes. */
const dialog = (open, seen) => ({ seen, open, close: (page) => page.keyboard.press("Escape") });

const kStates = {
  section: toggle("x", "section-panel"),
  explode: toggle("b", "explode-panel"),
  apart: toggle("j", "apart-panel"),
  measure: toggle("m", "measure-panel"),
  mate: toggle("c", "mate-panel"),
  workshop: toggle("u", "bench-panel"),
  menu: dialog((page) => page.getByTestId("menu.view").click(), "menu-views"),
  palette: dialog((page) => page.keyboard.press("Control+k"), "palette-input"),
  shortcuts: dialog((page) => page.keyboard.press("?"), "shortcuts"),
  views: dialog(async (page) => {
    await page.getByTestId("menu.view").click();
    await page.getByTestId("menu-views").click();
  }, "view-name"),
  devices: dialog(async (page) => {
    await page.getByTestId("menu.simulate").click();
    await page.getByTestId("menu-devices").click();
  }, "hand-0"),
  context: dialog((page) => page.getByTestId("part-1").click({ button: "right" }), "menu-path-points"),
  selected: { seen: "fit-input", open: (page) => page.getByTestId("part-2").click(), close: () => {} },
};

describe("every state of the page", () => {
  it("is sound in dark, 1280 x 720, and in light, 1024 x 768", withStudio([kBushing], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator, { isPlain: false });
    await waitForPicture(page);
    for (const [colorScheme, width, height] of [["dark", 1280, 720], ["light", 1024, 768]]) {
      await page.emulateMedia({ colorScheme });
      await page.setViewportSize({ width, height });
      for (const [name, { seen, open, close }] of Object.entries(kStates)) {
        await open(page);
        await page.getByTestId(seen).first().waitFor();
        await waitForCalm(page);
        assert.deepEqual(await findBarriers(page), [], name);
        await takePicture(page, `state_${name}_${colorScheme}`);
        await close(page);
      }
      const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
      assert.equal(wide, false, "nothing sticks out at the side");
    }
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));
});

describe("what one sets up", () => {
  it("stays: rims of panels, saved views, what is on the bench", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const rim = page.getByTestId("split-model");
    await rim.focus();
    const before = Number(await rim.getAttribute("aria-valuenow"));
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    assert.equal(Number(await rim.getAttribute("aria-valuenow")), before + 32);
    assert.equal(await page.evaluate(() => document.querySelector(".model-panel").clientWidth + 1 > 290), true);

    await page.keyboard.press("x");
    const offset = page.getByTestId("section-mm");
    await offset.fill("0.5 in");
    await offset.press("Enter");
    assert.match(await offset.inputValue(), /^12\.7 mm$/);
    await offset.fill("half a mile");
    assert.equal(await offset.getAttribute("aria-invalid"), "true");
    await offset.press("Escape");

    await page.getByTestId("menu.view").click();
    await page.getByTestId("menu-views").click();
    await page.getByTestId("view-name").fill("cut at half an inch");
    await page.getByTestId("view-keep").click();
    await page.getByRole("button", { name: "Close" }).last().click();
    await page.keyboard.press("x");
    await page.keyboard.press("u");
    await page.getByTestId("bench-hammer").click();
    assert.equal(await page.getByTestId("bench-hammer").getAttribute("aria-pressed"), "false");
    await takePicture(page, "workshop");

    await page.reload();
    await waitForPicture(page);
    assert.equal(Number(await page.getByTestId("split-model").getAttribute("aria-valuenow")), before + 32);
    await page.getByTestId("bench-panel").waitFor();
    assert.equal(await page.getByTestId("bench-hammer").getAttribute("aria-pressed"), "false");
    await page.getByTestId("menu.view").click();
    await page.getByTestId("menu-views").click();
    await page.getByRole("button", { name: "cut at half an inch", exact: true }).click();
    assert.match(await page.getByTestId("section-mm").inputValue(), /^12\.7 mm$/);
    await page.context().close();
  }));

  it("takes the product apart in the picture and leaves the work as it is", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const drawn = (id) => page.evaluate((o) => window.hvas.room.part(o), id);
    const drawnAtRest = () => waitForStill(page, () => drawn(2));
    const before = await drawnAtRest();
    await page.keyboard.press("j");
    const together = await drawnAtRest();
    await page.getByTestId("apart-next").click();
    const out = await drawnAtRest();
    assert.ok(out[2] - together[2] > 0.02, `the shaft has come out upwards: ${together[2]} to ${out[2]} m`);
    await takePicture(page, "apart");
    await page.keyboard.press("j");
    const after = await drawnAtRest();  // what lies on the table comes to rest within nanometres
    assert.ok(Math.hypot(...after.map((v, k) => v - before[k])) < 1e-6, `the shaft lies where it lay: ${before} and ${after}`);
    await waitForState(page, ({ placements }) => placements[2] === "loose");
    await page.context().close();
  }));
});
