// What participant and experimenter do in their pages, whatever server is behind them.
import { openPage } from "./harness.mjs";

export function openQuietPage(browser, link, options = {}) {
  return openPage(browser, link, { colorScheme: "light", ...options });
}

/** Presses a button as soon as it can be pressed. */
export async function press(page, testId) {
  await page.locator(`[data-testid="${testId}"]:not([aria-disabled="true"]):not(:disabled)`).click();
}

export async function agree(person) {
  await person.getByTestId("consent-agree").check();
  await press(person, "consent-begin");
}

/** Until the trial runs and its own scene is seen: the page says what to do then. */
export async function startTrial(person) {
  await press(person, "study-ready");
  await person.getByTestId("task-time").waitFor();
  await person.locator('[data-testid="task-hint"]:not([data-state="loading"])').waitFor();
}

export async function clickPart(page, occurrence) {
  await page.waitForFunction((id) => window.hvas.screen(id)?.isVisible, occurrence);
  const at = await page.evaluate((id) => window.hvas.screen(id), occurrence);
  await page.mouse.click(at.x, at.y);
}
