import { describe, expect, it } from "vitest";
import { countDone, dropTicked, follow, kGuideBegin, shownSteps } from "../src/model/guide";
import { kHoldStates } from "../src/protocol/messages";

const steps = (guidance: Parameters<typeof shownSteps>[0]) =>
  shownSteps(guidance).map(({ step, number, isDone, isNext }) => `${number} ${step}${isDone ? " done" : ""}${isNext ? " next" : ""}`);

describe("the guide through the first part", () => {
  it("counts a step when the part is in the hand, near its place, and seated", () => {
    expect(kHoldStates.map((state) => countDone(state, false))).toEqual([0, 1, 2, 2, 2, 3]);
  });

  it("is done as well when the part went to its place as it was let go", () => {
    expect(countDone("empty", true)).toBe(3);
  });

  it("ticks what is done, and drops it when the tick has been seen", () => {
    expect(steps(kGuideBegin)).toEqual(["1 take next", "2 bring", "3 push"]);
    const taken = follow(kGuideBegin, 1);
    expect(steps(taken)).toEqual(["1 take done", "2 bring next", "3 push"]);
    expect(steps(dropTicked(taken))).toEqual(["2 bring next", "3 push"]);
    const seated = follow(dropTicked(taken), 3);
    expect(steps(seated)).toEqual(["2 bring done", "3 push done"]);
    expect(steps(dropTicked(seated))).toEqual([]);
  });

  it("brings a step back when the part slips out of the hand", () => {
    const near = dropTicked(follow(kGuideBegin, 2));
    expect(steps(near)).toEqual(["3 push next"]);
    expect(steps(follow(near, 0))).toEqual(["1 take next", "2 bring", "3 push"]);
    expect(steps(follow(near, 1))).toEqual(["2 bring next", "3 push"]);
  });
});
