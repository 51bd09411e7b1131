// Mates and fits defined, changed and removed in the 3D view (X8, X12).
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  copyToTemporary,
  fetchScene,
  findAndClickFace,
  noticeAfter,
  openPage,
  runProgram,
  shareBrowser,
  takePicture,
  turnViewByKeys,
  waitForPicture,
  waitForState,
  withStudio,
} from "./harness.mjs";

const kBushing = "../products/bushing.step";
const [kSleeve, kShaft] = [1, 2];

shareBrowser();

/** A mate of the product with its number out of it, as if inference had not found it. */
function removeMate(kind, a, b) {
  const file = copyToTemporary([kBushing, kBushing.replace(".step", ".hvas.json")]);
  const { mates } = JSON.parse(runProgram(["inspect", file, "--json"]));
  const of = (m) => [m.hole?.occurrence ?? m.a?.occurrence, m.shaft?.occurrence ?? m.b?.occurrence];
  const found = mates.find((m) => m.kind === kind && of(m).includes(a) && of(m).includes(b));
  runProgram(["mate", "remove", file, `m${found.id}`]);
  return { file, mate: found };
}

async function epochAfter(page, epoch) {
  return waitForState(page, (state) => state.hasScene && state.epoch > epoch);
}

describe("a mate", () => {
  it("is defined by two clicks and a fit, and removed again", async () => {
    const { file, mate } = removeMate("axis_hole", kSleeve, kShaft);
    await withStudio([file], async (studio) => {
      const { page, complaints } = await openPage(browser, studio.operator);
      await waitForPicture(page);
      const before = await fetchScene(page);
      await page.keyboard.press("c");
      await page.getByTestId("mate-panel").waitFor();
      const [hole, shaft] = [mate.surfaces[0].a, mate.surfaces[0].b];
      await findAndClickFace(page, mate.hole.occurrence, hole, kShaft, turnViewByKeys);
      await findAndClickFace(page, mate.shaft.occurrence, shaft, kShaft, turnViewByKeys);
      await page.getByTestId("mate-fit").fill("H7/k6");
      await takePicture(page, "mate_picked");
      await page.getByTestId("mate-create").click();
      await epochAfter(page, before.epoch);
      const after = await fetchScene(page);
      const added = after.mates.find((m) => m.origin === "user");
      assert.equal(after.mates.length, before.mates.length + 1);
      assert.deepEqual([added.kind, added.fit.code], ["axis_hole", "H7/k6"]);
      const line = page.getByTestId(`mate-${added.id}`);
      await line.waitFor();
      assert.match(await line.textContent(), /H7\/k6/);
      await takePicture(page, "mate_added");

      await page.getByTestId(`remove-mate-${added.id}`).click();
      await epochAfter(page, after.epoch);
      assert.equal((await fetchScene(page)).mates.length, before.mates.length);
      await page.keyboard.press("Control+z");
      await waitForState(page, ({ epoch }) => epoch === after.epoch);
      assert.equal((await fetchScene(page)).mates.length, after.mates.length, "undone");
      assert.deepEqual(complaints, []);
      await page.context().close();
    })();
  });

  it("that cannot be is refused with the reason", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const { mates, epoch } = await fetchScene(page);
    const shaft = mates.find((m) => m.kind === "axis_hole" && m.b === kShaft);
    const planes = mates.filter((m) => m.kind === "face_face").flatMap((m) => [[m.a, m.faces_a[0]], [m.b, m.faces_b[0]]]);
    const seen = await page.evaluate(
      ([faces, sleeve]) => faces.find(([o, f]) => o === sleeve && window.hvas.screenOfFace(o, f) !== null),
      [planes, kSleeve],
    );
    await page.keyboard.press("c");
    await findAndClickFace(page, kShaft, shaft.faces_b[0], kShaft, turnViewByKeys);
    await findAndClickFace(page, ...seen, kShaft, turnViewByKeys);
    const reason = await noticeAfter(page, () => page.getByTestId("mate-create").click());
    assert.match(reason, /a plane and a shaft|a shaft and a plane/);
    await takePicture(page, "mate_refused");
    assert.equal((await fetchScene(page)).epoch, epoch);
    await page.context().close();
  }));

  it("keeps its card whatever becomes of its fit, and the fits of others", withStudio(["../products/gear_pump.step"], async (studio) => {
    const { page, complaints } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const fitsOf = async () => (await fetchScene(page)).mates.filter((m) => m.fit).map((m) => [m.key, m.fit.code]);
    const { mates } = await fetchScene(page);
    // A bushing that is pressed into one part, and in which another one runs.
    const pressed = mates.find((m) => m.fit?.kind === "interference" && mates.some((n) => n.fit?.kind === "clearance" && n.a === m.b));
    const before = await fitsOf();
    const card = page.getByTestId("fit-card");
    await page.getByTestId(`part-${pressed.b}`).click();
    await card.waitFor();
    await page.getByTestId("fit-mate").selectOption(pressed.key);
    const told = await page.getByTestId("fit-mate").evaluate((select) => select.selectedOptions[0].text);
    for (const code of ["H7/g6", "H11/c11", pressed.fit.code]) {
      const { epoch } = await fetchScene(page);
      await page.getByTestId("fit-input").fill(code);
      await page.getByTestId("fit-apply").click();
      await epochAfter(page, epoch);
      await card.getByRole("heading", { name: code }).waitFor();
      assert.equal(await page.getByTestId("fit-mate").inputValue(), pressed.key);
      await takePicture(page, `fit_card_${code.replace("/", "_")}`);
    }
    assert.equal(await page.getByTestId("fit-mate").evaluate((select) => select.selectedOptions[0].text), told);
    assert.deepEqual(await fitsOf(), before, "all as it was");
    // Of a mate that is chosen in the list, the card is its own.
    const running = mates.find((m) => m.fit?.kind === "clearance" && m.a === pressed.b);
    await page.getByTestId(`mate-${running.id}`).click();
    await page.locator(`[data-testid="fit-card"][data-mate="${running.id}"]`).waitFor();
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));

  it("with a fit that there is not is refused, and what was picked stays", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const { mates, epoch } = await fetchScene(page);
    const shaft = mates.find((m) => m.kind === "axis_hole" && m.b === kShaft);
    await page.keyboard.press("c");
    await findAndClickFace(page, kShaft, shaft.faces_b[0], kShaft, turnViewByKeys);
    await page.getByTestId("part-0").waitFor();
    const seen = await page.evaluate(
      (faces) => faces.find(([o, f]) => window.hvas.screenOfFace(o, f) !== null),
      mates.filter((m) => m.kind === "axis_hole").map((m) => [m.a, m.faces_a[0]]),
    );
    await findAndClickFace(page, ...seen, kShaft, turnViewByKeys);
    const picked = await page.getByTestId("mate-panel").locator(".picked").textContent();
    await page.getByTestId("mate-fit").fill("H7");
    assert.equal(await page.getByTestId("mate-create").isDisabled(), true);
    await page.getByTestId("mate-fit").fill("H7/zz99");
    await noticeAfter(page, () => page.getByTestId("mate-create").click());
    await takePicture(page, "mate_bad_fit");
    assert.equal(await page.getByTestId("mate-panel").locator(".picked").textContent(), picked);
    assert.equal(await page.getByTestId("mate-fit").inputValue(), "H7/zz99");
    assert.equal((await fetchScene(page)).epoch, epoch);
    await page.context().close();
  }));

  it("changes its fit in the inspector", withStudio([kBushing], async (studio) => {
    const { page } = await openPage(browser, studio.operator);
    await waitForPicture(page);
    const before = await fetchScene(page);
    await page.getByTestId(`part-${kShaft}`).click();
    const input = page.getByTestId("fit-input");
    await input.waitFor();
    await input.fill("H7/p6");
    await page.getByTestId("fit-apply").click();
    await epochAfter(page, before.epoch);
    const fits = (await fetchScene(page)).mates.filter((m) => (m.a === kShaft || m.b === kShaft) && m.fit).map((m) => m.fit.code);
    assert.ok(fits.includes("H7/p6"), `${fits}`);
    await page.getByRole("heading", { name: /H7\/p6/ }).waitFor();
    await takePicture(page, "fit_changed");
    await input.fill("H7/zz99");
    await noticeAfter(page, () => page.getByTestId("fit-apply").click());
    await takePicture(page, "fit_refused");
    await page.context().close();
  }));
});
