// What makes the work easier, and that everybody can use it: in each of its states the page has nothing
// that axe finds (WCAG 2.2 AA).
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { launchBrowser, openPage, takePicture, waitForPicture, waitForState, withStudio } from "./harness.mjs";

const kBushing = "../products/bushing.step";
const kRules = ["wcag2a", "wcag2aa", "wcag21aa", "wcag22aa"];

let browser;
before(async () => {
  browser = await launchBrowser();
});
after(() => browser.close());

/** A key that opens something and closes it again. */
const toggle = (key) => ({ open: (page) => page.keyboard.press(key), close: (page) => page.keyboard.press(key) });
/** What Escape closes. */
const dialog = (open) => ({ open, close: (page) => page.keyboard.press("Escape") });

const kStates = {
  section: toggle("x"),
  explode: toggle("b"),
  apart: toggle("j"),
  measure: toggle("m"),
  mate: toggle("c"),
  workshop: toggle("u"),
  menu: dialog((page) => page.getByTestId("menu.view").click()),
  palette: dialog((page) => page.keyboard.press("Control+k")),
  shortcuts: dialog((page) => page.keyboard.press("?")),
  views: dialog(async (page) => {
    await page.getByTestId("menu.view").click();
    await page.getByTestId("menu-views").click();
    await page.getByTestId("view-name").waitFor();
  }),
  context: dialog(async (page) => {
    await page.getByTestId("part-1").click({ button: "right" });
    await page.getByTestId("menu-path-points").waitFor();
  }),
  selected: { open: (page) => page.getByTestId("part-2").click(), close: () => {} },
};

async function findFaults(page) {
  const found = await page.evaluate((rules) => window.axe.run(document, { runOnly: rules }), kRules);
  return found.violations.map((v) => `${v.id}: ${v.nodes[0]?.html}`);
}

describe("every state of the page", () => {
  for (const [colorScheme, width, height] of [["dark", 1280, 720], ["light", 1024, 768]]) {
    it(`is sound in ${colorScheme}, ${width} x ${height}`, withStudio([kBushing], async (studio) => {
      const viewport = { width, height };
      const { page, complaints } = await openPage(browser, studio.operator, { colorScheme, viewport, bypassCSP: true });
      await waitForPicture(page);
      await page.addScriptTag({ path: "node_modules/axe-core/axe.min.js" });
      for (const [name, { open, close }] of Object.entries(kStates)) {
        await open(page);
        await page.waitForTimeout(250);
        assert.deepEqual(await findFaults(page), [], name);
        await takePicture(page, `state_${name}_${colorScheme}`);
        await close(page);
      }
      const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
      assert.equal(wide, false, "nothing sticks out at the side");
      assert.deepEqual(complaints, []);
      await page.context().close();
    }));
  }
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
    const { page } = await openPage(browser, studio.operator, { reducedMotion: "reduce" });
    await waitForPicture(page);
    const drawn = (id) => page.evaluate((o) => window.hvas.room.part(o), id);
    const before = await drawn(2);
    await page.keyboard.press("j");
    await page.waitForTimeout(700);
    const together = await drawn(2);
    await page.getByTestId("apart-next").click();
    await page.waitForTimeout(700);
    const out = await drawn(2);
    assert.ok(out[2] - together[2] > 0.02, `the shaft has come out upwards: ${together[2]} to ${out[2]} m`);
    await takePicture(page, "apart");
    await page.keyboard.press("j");
    await page.waitForTimeout(700);
    assert.deepEqual(await drawn(2), before);
    await waitForState(page, ({ placements }) => placements[2] === "loose");
    await page.context().close();
  }));
});
