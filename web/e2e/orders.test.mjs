// The order of assembly: found, dragged, checked and used.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  fetchScene,
  findBarriers,
  kPatienceMs,
  nextFrame,
  openPage,
  shareBrowser,
  takePicture,
  waitForCalm,
  waitForPicture,
  withStudio,
} from "./harness.mjs";

shareBrowser();

const inserted = (scene) => scene.steps.filter((step) => step.kind === "insert").map((step) => step.occurrence);

/** Waits until the order on the page has been checked; what it comes to. */
async function waitForSummary(page) {
  const summary = page.getByTestId("order-summary");
  await page.waitForFunction(() => {
    const text = document.querySelector("[data-testid=order-summary]")?.textContent ?? "";
    return text !== "" && !text.includes("…");
  }, null);
  return summary.textContent();
}

describe("the order of assembly", () => {
  it("is found, dragged with reasons why not, and used", withStudio(["../products/gear_pump.step"], async (studio) => {
    const look = { colorScheme: "dark", viewport: { width: 1280, height: 900 } };
    const { page, complaints } = await openPage(browser, studio.operator, look);
    await waitForPicture(page);
    const before = inserted(await fetchScene(page));
    await page.getByTestId("order-open").click();
    assert.match(await waitForSummary(page), /^Cost \d+/);

    // The last part that goes in cannot come first.
    const last = page.getByTestId(`order-handle-${before.length - 1}`);
    await last.scrollIntoViewIfNeeded();
    await last.focus();
    for (let place = before.length - 1; place > 0; place--) {
      await page.keyboard.press("ArrowUp");
      await page.getByTestId(`order-handle-${place - 1}`).and(page.locator(":focus")).waitFor();
    }
    assert.match(await waitForSummary(page), /cannot come where/);
    const bad = page.locator(".order .is-bad");
    assert.match(await bad.first().textContent(), /Cannot come here: in its way is/);
    assert.equal(await page.getByTestId("order-use").isDisabled(), true);
    await waitForCalm(page);
    assert.deepEqual(await findBarriers(page), []);
    await takePicture(page, "order_fails");

    // An order that was found is possible; dragged by the mouse it is an own one.
    await page.getByTestId("order-find").click();
    await page.getByTestId("order-choice").waitFor();
    assert.match(await waitForSummary(page), /^Cost \d+/);
    const choices = page.getByTestId("order-choice").locator("option");
    assert.ok((await choices.count()) >= 2);
    const from = page.getByTestId("order-handle-0");
    await from.scrollIntoViewIfNeeded();
    const [start, end] = [await from.boundingBox(), await page.getByTestId("order-row-2").boundingBox()];
    const first = await page.getByTestId("order-row-0").textContent();
    await page.mouse.move(start.x + start.width / 2, start.y + start.height / 2);
    await page.mouse.down();
    await page.mouse.move(start.x + start.width / 2, end.y + end.height / 2 + 3, { steps: 8 });
    await page.mouse.up();
    const name = first.replace(/^1\. /, "").split(/(?:Then hold|Cannot come|Its tool)/)[0];
    assert.ok((await page.getByTestId("order-row-2").textContent()).includes(name), name);
    assert.equal(await page.getByTestId("order-choice").inputValue(), "");
    await waitForSummary(page);
    await takePicture(page, "order_dragged");

    await page.getByTestId("order-choice").selectOption("0");
    await waitForSummary(page);
    await page.getByTestId("order-use").click();
    await page.getByTestId("order-open").waitFor();
    const deadline = Date.now() + kPatienceMs;
    let after = before;
    while (after.join() === before.join() && Date.now() < deadline) {
      await nextFrame(page);
      after = inserted(await fetchScene(page));
    }
    assert.notDeepEqual(after, before);
    assert.deepEqual([...after].sort(), [...before].sort());
    assert.deepEqual(complaints, []);
    await page.context().close();
  }));
});
