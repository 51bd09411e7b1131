// A session of a study, as the participant and as the experimenter sees it (docs/studio.md). Whoever is not looked at is
// there without a page: two pictures are too much for a slow machine. `study_live.test.mjs` does its trials by hand.
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
import { withStudy } from "./study_server.mjs";
import { agree, clickPart, openQuietPage, press, startTrial } from "./study_steps.mjs";

const [kSleeve, kShaft] = [1, 2];
const kTablet = { width: 834, height: 1112 };
/** What a fit or a condition is called; none of it may ever be in a participant's page. */
const kSecrets = /H7\/|\b(A1|B1|B2)\b|Clearance|Interference|µm|seed/;

shareBrowser();

/** The experimenter without a page, once the session can begin. */
async function joinAsExperimenter(study) {
  const desk = study.join(study.operator);
  await desk.until((state) => state.is_open);
  return desk;
}

/** The participant's page, and the experimenter without one. */
async function openAsParticipant(study, options) {
  const { page: person, complaints } = await openQuietPage(browser, study.participant, options);
  await person.getByTestId("page-waiting").waitFor();
  return { person, complaints, desk: await joinAsExperimenter(study) };
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

/** In a trial by picking: wrong surfaces are refused. */
async function pickWrongSurfaces(person) {
  await person.getByText("Click a surface of the marked part.").waitFor();
  await waitForView(person);
  await takePicture(person, "study_picking");
  await clickPart(person, 0);
  await person.getByText("Now click the surface that it belongs to.").waitFor();
  await clickPart(person, kSleeve);
  await person.getByText("These two do not belong together.").waitFor();
}

describe("a participant", () => {
  it("comes from the consent to the thanks, and each page can be used by all", withStudy(async (study) => {
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
    await person.keyboard.press("g");
    await waitForState(person, (state) => state.held.length === 1);
    await takePicture(person, "study_trial_held");
    await assertTellsNothing(person);
    await desk.do("next");

    for (const trial of [2, 3]) {
      await person.getByText(`Trial ${trial}`, { exact: true }).waitFor();
      await startTrial(person);
      await desk.do("next");
      await person.getByTestId("question-choice").waitFor();
      if (trial === 2) {
        await look(person, "identify");
        assert.equal(await person.getByTestId("answer-skip").count(), 0, "it has to be answered");
      }
      await person.getByTestId("answer-H7/p6").check();
      await press(person, "answer-send");
    }

    await person.getByText("Trial 4", { exact: true }).waitFor();
    await startTrial(person);
    await pickWrongSurfaces(person);
    await desk.do("next");

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
    const [first, ...blind] = done.map(({ condition, outcome, is_right: isRight }) => [condition, outcome, isRight]);
    assert.deepEqual(first, ["B1", "not_done", null]);
    assert.deepEqual(blind.slice(0, 2).sort(), [["B1", "not_done", false], ["B2", "not_done", true]], "H7/p6 was one of them");
    assert.deepEqual(blind[2], ["A1", "not_done", null]);
    assert.deepEqual(answers.map(({ value }) => value), [8, "The second one creaked."]);
    assert.deepEqual(complaints, []);
    await person.context().close();
  }));

  it("who does not agree is asked nothing more", withStudy(async (study) => {
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

  it("reads German on a tablet, from the consent on", withStudy(async (study) => {
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

  it("can switch the forces off by Esc and by the button, and on again", withStudy(async (study) => {
    const { desk, person } = await openAsParticipant(study);
    await desk.do("begin");
    await agree(person);
    await passTraining(desk, person);
    await person.keyboard.press("Escape");
    await waitForState(person, (state) => state.forcesOff);
    await startTrial(person);
    await person.getByTestId("study-forces-off").waitFor();
    await look(person, "forces_off");
    await press(person, "forces-on");
    await waitForState(person, (state) => !state.forcesOff);
    await press(person, "forces-off");
    await waitForState(person, (state) => state.forcesOff);
    await person.context().close();
  }));

  it("finds none of the studio's keys, menus, panels and secrets", withStudy(async (study) => {
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
    await waitForState(person, (state) => state.held.length === 1);
    await assertTellsNothing(person);
    const told = await person.evaluate(async () => {
      const scene = await (await fetch("/api/scene")).json();
      return { fits: scene.mates.map((mate) => mate.fit), seed: scene.seed ?? null };
    });
    assert.ok(told.fits.every((fit) => fit === null) && told.seed === null);
    await person.context().close();
  }));

  it("waits where the connection is lost, and goes on where it was", withStudy(async (study) => {
    const line = await study.overLine(study.participant);
    const { desk, person } = await openAsParticipant({ ...study, participant: line.link });
    await desk.do("begin");
    await person.getByTestId("consent-agree").check();
    await line.cut();
    await person.getByTestId("study-lost").waitFor();
    await takePicture(person, "study_lost");
    await line.mend();
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
  it("sees what the participant sees, and can do nothing", withStudy(async (study) => {
    const [desk, person] = [await joinAsExperimenter(study), study.join(study.participant)];
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
  it("sees all of a session, writes notes, aborts for a reason, and goes on", withStudy(async (study) => {
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
    await person.insertHalf(kShaft);
    await desk.getByTestId("desk-hold").getByText("mating").waitFor();
    await takePicture(desk, "study_desk_mating");
    await person.insert();
    await person.until((state) => state.phase === "ready" && state.trial === 2);
    for (const trial of [2, 3]) {
      await person.until((state) => state.phase === "ready" && state.trial === trial);
      await person.do("ready");
      await person.until((state) => state.phase === "running" && state.elapsed_s !== null);
      await press(desk, "desk-not-done");
      await person.until((state) => state.phase === "question");
      await person.do("answer", { question: "identify", value: "H7/g6" });
    }
    await desk.locator('[data-testid="desk-trials"] tbody').getByText("not done").first().waitFor();
    await person.do("ready");
    await person.until((state) => state.phase === "running" && state.elapsed_s !== null);
    await press(desk, "desk-not-done");
    await person.until((state) => state.phase === "question");
    await person.do("answer", { question: "steady", value: 8 });
    await person.do("answer", { question: "remarks", value: null });
    await desk.locator('[data-testid="desk-phase"][data-phase="done"]').waitFor();
    assert.equal(await desk.locator('table[data-testid="desk-trials"] tbody tr').count(), 4);
    assert.match(await desk.locator('table[data-testid="desk-trials"]').innerText(), /H7\/g6 ✗/);
    assert.match(await desk.getByTestId("desk-answers").innerText(), /steady\s*8\s*remarks\s*no answer/);
    await look(desk, "desk_done");
    await lookAsPaper(desk, "desk_done");
    assert.deepEqual(complaints, []);
    await desk.context().close();
  }));

  it("has a link for the participant until there is one, and does not take the hand", withStudy(async (study) => {
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
