// A session of a study, as the participant and as the experimenter sees it (docs/studio.md), with the mock's study of
// three trials. Whoever is not looked at is there without a page: two pictures are too much for a slow machine.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import {
  browser,
  findBarriers,
  shareBrowser,
  takePicture,
  waitForAnswer,
  waitForCalm,
  waitForPicture,
  waitForState,
  waitForView,
} from "./harness.mjs";
import { withMockStudy } from "./study_mock.mjs";
import { agree, clickPart, kPatient, openQuietPage, press, startTrial } from "./study_steps.mjs";

const kShaft = 2;
const kTablet = { width: 834, height: 1112 };
/** What a fit or a condition is called; none of it may ever be in a participant's page. */
const kSecrets = /H7\/|\b(A1|B1|B2)\b|Clearance|Interference|µm|seed/;

shareBrowser();

/** The participant's page, and the experimenter without one. */
async function openAsParticipant(study, options) {
  const { page: person, complaints } = await openQuietPage(browser, study.participant, options);
  await person.getByTestId("page-waiting").waitFor();
  return { person, complaints, desk: study.join(study.operator) };
}

/** The experimenter's page, and the participant without one. */
async function openAsExperimenter(study) {
  const { page: desk, complaints } = await openQuietPage(browser, study.operator, { viewport: { width: 1440, height: 900 } });
  await desk.getByTestId("desk").waitFor();
  return { desk, complaints, person: study.join(study.participant) };
}

/** A picture of the page in both themes, after axe has looked at both. */
async function look(page, name) {
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    await waitForCalm(page);
    assert.deepEqual(await findBarriers(page), [], `${name}, ${colorScheme}`);
    await takePicture(page, `study_${name}_${colorScheme}`);
  }
}

async function lookAsPaper(page, name) {
  await page.emulateMedia({ media: "print", colorScheme: "light" });
  await takePicture(page, `study_${name}_print`);
  await page.emulateMedia({ media: "screen" });
}

async function assertTellsNothing(page) {
  const text = await page.evaluate(() => `${document.title} ${document.body.innerHTML}`);
  assert.doesNotMatch(text, kSecrets);
  const panels = ".header, .menu-bar, .model-panel, .inspector, .tool-rail, .plots, .status, .legend, .hint-bar, dialog";
  assert.equal(await page.locator(panels).count(), 0);
}

/** To before the first trial. */
async function passTraining(desk, person) {
  await person.getByTestId("page-training").waitFor();
  await desk.do("ready");
  await desk.do("next");
  await person.getByTestId("page-ready").waitFor();
}

/** Until the part is half in. */
function waitForMating(person) {
  return person.locator('[data-testid="task-hint"][data-state="mating"]').waitFor();
}

/** In a trial by picking: wrong surfaces are refused, two right pairs end it. */
async function pickSurfaces(person) {
  await person.getByText("Click a surface of the marked part.").waitFor();
  await waitForView(person);
  await takePicture(person, "study_picking");
  await clickPart(person, 0);
  await person.getByText("Now click the surface that it belongs to.").waitFor();
  await clickPart(person, 1);
  await person.getByText("These two do not belong together.").waitFor();
  await clickPart(person, kShaft);
  await clickPart(person, 1);
  await person.getByText("Constraints left: 1").waitFor();
  await takePicture(person, "study_picking_left");
  await clickPart(person, kShaft);
  await clickPart(person, 1);
}

describe("a participant", () => {
  it("comes from the consent to the thanks, and each page can be used by all", withMockStudy(async (study) => {
    const { desk, person, complaints } = await openAsParticipant(study);
    await look(person, "waiting");
    await desk.do("begin");

    await person.getByTestId("page-consent").waitFor();
    await look(person, "consent");
    await lookAsPaper(person, "consent");
    await press(person, "consent-begin");
    await person.getByText("Please tick the box first").waitFor();
    await takePicture(person, "study_consent_missed");
    await agree(person);

    await person.getByTestId("page-training").waitFor();
    await look(person, "training");
    await press(person, "study-ready");
    await person.getByTestId("task-time").waitFor();
    await waitForPicture(person);
    await look(person, "training_runs");
    await desk.do("next");

    await person.getByTestId("page-ready").waitFor();
    await look(person, "ready");
    await startTrial(person);
    study.work();
    await waitForMating(person);
    await takePicture(person, "study_trial_mating");
    await assertTellsNothing(person);
    study.work();

    await person.getByText("Trial 2", { exact: true }).waitFor();
    await startTrial(person);
    study.work();
    await waitForMating(person);
    study.work();
    await person.getByTestId("question-choice").waitFor();
    await look(person, "identify");
    assert.equal(await person.getByTestId("answer-skip").count(), 0, "it has to be answered");
    await person.getByTestId("answer-H7/p6").check();
    await press(person, "answer-send");

    await person.getByText("Trial 3", { exact: true }).waitFor();
    await startTrial(person);
    await pickSurfaces(person);

    await person.getByTestId("question-scale").waitFor();
    await press(person, "answer-send");
    await person.getByText("Please choose or write an answer first.").waitFor();
    await look(person, "scale");
    await person.keyboard.press("Space");
    for (let k = 1; k < 8; k++) {
      await person.keyboard.press("ArrowRight");
    }
    assert.ok(await person.getByTestId("answer-8").isChecked(), "by the keys alone");
    await takePicture(person, "study_scale_chosen");
    await lookAsPaper(person, "scale");
    await press(person, "answer-send");

    await person.getByTestId("question-text").waitFor();
    await person.getByTestId("answer-text").fill("x".repeat(201));
    await press(person, "answer-send");
    await person.getByText("This is too long. Please shorten it.").waitFor();
    await person.getByTestId("answer-text").fill("The second one creaked.");
    await look(person, "text");
    await press(person, "answer-send");

    await person.getByTestId("page-done").waitFor();
    await look(person, "done");
    const { done, answers } = await desk.until((state) => state.phase === "done");
    assert.deepEqual(done.map(({ condition, outcome }) => [condition, outcome]), [["B1", "done"], ["B2", "done"], ["A1", "done"]]);
    assert.equal(done[1].is_right, true);
    assert.deepEqual(answers.map(({ value }) => value), [8, "The second one creaked."]);
    assert.deepEqual(complaints, []);
    await person.context().close();
  }));

  it("who does not agree is asked nothing more", withMockStudy(async (study) => {
    const { desk, person } = await openAsParticipant(study);
    await desk.do("begin");
    await press(person, "consent-decline");
    await person.getByTestId("decline-confirm").waitFor();
    await look(person, "decline");
    await press(person, "decline-yes");
    await person.getByTestId("page-declined").waitFor();
    await look(person, "declined");
    await desk.until((state) => state.phase === "declined");
    await person.context().close();
  }));

  it("reads German on a tablet, from the consent on", withMockStudy(async (study) => {
    const { desk, person } = await openAsParticipant(study, { viewport: kTablet, hasTouch: true });
    await desk.do("begin");
    await person.getByTestId("study-language-de").check();
    await person.getByText("Ich habe das gelesen").waitFor();
    await person.getByText("Sie setzen eine Welle in eine Buchse").waitFor();
    await look(person, "consent_tablet_de");
    await agree(person);
    await person.getByText("Übung beginnen").waitFor();
    await passTraining(desk, person);
    assert.equal(await person.evaluate(() => document.documentElement.lang), "de");
    await startTrial(person);
    await waitForPicture(person);
    await look(person, "trial_tablet_de");
    await person.context().close();
  }));

  it("can switch the forces off by Esc and by the button, and on again", withMockStudy(async (study) => {
    const { desk, person } = await openAsParticipant(study);
    await desk.do("begin");
    await agree(person);
    await passTraining(desk, person);
    await person.keyboard.press("Escape");
    await waitForState(person, (state) => state.forcesOff, kPatient);
    await startTrial(person);
    await person.getByTestId("study-forces-off").waitFor();
    await look(person, "forces_off");
    await press(person, "forces-on");
    await waitForState(person, (state) => !state.forcesOff, kPatient);
    await press(person, "forces-off");
    await waitForState(person, (state) => state.forcesOff, kPatient);
    await person.context().close();
  }));

  it("finds none of the studio's keys, menus, panels and secrets", withMockStudy(async (study) => {
    const { desk, person } = await openAsParticipant(study);
    await desk.do("begin");
    await agree(person);
    await passTraining(desk, person);
    await startTrial(person);
    await waitForPicture(person);
    for (const key of ["Control+k", "?", "x", "b", "c", "m", "/"]) {
      await person.keyboard.press(key);
    }
    const at = await person.evaluate((id) => window.hvas.screen(id), kShaft);
    await person.mouse.click(at.x, at.y, { button: "right" });
    await waitForAnswer(person);
    await waitForCalm(person);
    await assertTellsNothing(person);
    await person.keyboard.press("g");
    await waitForState(person, (state) => state.held.length === 1, kPatient);
    await assertTellsNothing(person);
    const told = await person.evaluate(async () => {
      const scene = await (await fetch("/api/scene")).json();
      return { fits: scene.mates.map((mate) => mate.fit), seed: scene.seed ?? null };
    });
    assert.ok(told.fits.every((fit) => fit === null) && told.seed === null);
    await person.context().close();
  }));

  it("waits where the connection is lost, and goes on where it was", withMockStudy(async (study) => {
    const { desk, person } = await openAsParticipant(study);
    await desk.do("begin");
    await person.getByTestId("consent-agree").check();
    study.cut();
    await person.getByTestId("study-lost").waitFor();
    await takePicture(person, "study_lost");
    study.mend();
    await person.getByTestId("study-lost").waitFor({ state: "detached" });
    assert.ok(await person.getByTestId("consent-agree").isChecked(), "what was ticked stays so");
    await press(person, "consent-begin");
    await person.getByTestId("page-training").waitFor();
    await person.reload();
    await person.getByTestId("page-training").waitFor();
    await person.context().close();
  }));
});

describe("a viewer", () => {
  it("sees what the participant sees, and can do nothing", withMockStudy(async (study) => {
    const [desk, person] = [study.join(study.operator), study.join(study.participant)];
    await desk.do("begin");
    const { page } = await openQuietPage(browser, study.viewer);
    await page.getByTestId("page-consent").waitFor();
    await page.getByText("You are watching").waitFor();
    assert.ok(await page.getByTestId("consent-agree").isDisabled());
    assert.equal(await page.getByTestId("consent-begin").getAttribute("aria-disabled"), "true");
    await person.do("consent", { agreed: true, language: "en" });
    await desk.do("ready");
    await page.getByTestId("task-time").waitFor();
    await waitForPicture(page);
    await assertTellsNothing(page);
    await look(page, "viewer");
    await page.context().close();
  }));
});

describe("the experimenter", () => {
  it("sees all of a session, writes notes, aborts for a reason, and goes on", withMockStudy(async (study) => {
    const { desk, person, complaints } = await openAsExperimenter(study);
    await waitForPicture(desk);
    await press(desk, "desk-begin");
    await person.until((state) => state.phase === "consent");
    await person.do("consent", { agreed: true, language: "en" });
    await press(desk, "desk-ready");
    await press(desk, "desk-end-training");
    await desk.getByTestId("note-text").fill("Left-handed.");
    await desk.keyboard.press("Enter");
    await desk.getByTestId("notes").getByText("Left-handed.").waitFor();

    await press(desk, "desk-ready");
    await desk.locator('[data-testid="desk-phase"][data-phase="running"]').waitFor();
    await look(desk, "desk_running");
    await press(desk, "desk-abort");
    await desk.getByTestId("abort-yes").click();
    await desk.getByText("Give a reason: it is saved with the session.").waitFor();
    await look(desk, "desk_abort");
    await desk.getByTestId("abort-reason").fill("The telephone rang.");
    await desk.getByTestId("abort-yes").click();
    await person.until((state) => state.phase === "paused");
    await desk.getByText("Paused: The telephone rang.").waitFor();
    await look(desk, "desk_paused");
    await press(desk, "desk-resume");
    assert.equal((await person.until((state) => state.phase === "ready")).trial, 1, "it is done again");

    await press(desk, "desk-ready");
    await person.until((state) => state.elapsed_s !== null);
    study.work();
    await desk.getByTestId("desk-hold").getByText("mating").waitFor();
    await takePicture(desk, "study_desk_mating");
    study.work();
    await person.until((state) => state.phase === "ready" && state.trial === 2);
    await person.do("ready");
    await press(desk, "desk-not-done");
    await desk.locator('[data-testid="desk-trials"] tbody').getByText("not done").waitFor();
    await person.do("answer", { question: "identify", value: "H7/g6" });
    await person.do("ready");
    await press(desk, "desk-not-done");
    await person.until((state) => state.phase === "question");
    await person.do("answer", { question: "steady", value: 8 });
    await person.do("answer", { question: "remarks", value: null });
    await desk.locator('[data-testid="desk-phase"][data-phase="done"]').waitFor();
    assert.equal(await desk.locator('table[data-testid="desk-trials"] tbody tr').count(), 3);
    assert.match(await desk.locator('table[data-testid="desk-trials"]').innerText(), /H7\/g6 ✗/);
    assert.match(await desk.getByTestId("desk-answers").innerText(), /steady\s*8\s*remarks\s*no answer/);
    await look(desk, "desk_done");
    await lookAsPaper(desk, "desk_done");
    assert.deepEqual(complaints, []);
    await desk.context().close();
  }));

  it("has a link for the participant until there is one, and does not take the hand", withMockStudy(async (study) => {
    const { page: desk } = await openQuietPage(browser, study.operator);
    await desk.getByTestId("participant-link").waitFor();
    assert.equal(await desk.getByTestId("participant-link").inputValue(), study.participant);
    await look(desk, "desk_alone");
    study.join(study.participant);
    await desk.getByTestId("participant-link").waitFor({ state: "detached" });
    assert.equal(await desk.getByTestId("hint-lease").count(), 0);
    await desk.evaluate(() => document.activeElement?.blur());
    await desk.keyboard.press("d");
    await waitForAnswer(desk);
    await waitForCalm(desk);
    assert.equal(await desk.getByTestId("demo-runs").count(), 0);
    await desk.context().close();
  }));
});
