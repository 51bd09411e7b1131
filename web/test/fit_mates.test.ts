import { describe, expect, it } from "vitest";
import { firstMate, isFitCode, mateKey, matesWithFit } from "../src/model/fit_mates";
import { chooseCardMate, chosenCardMate, makeViewState } from "../src/model/view_state";
import type { Fit, Mate } from "../src/protocol/messages";

const [kCover, kBushing, kShaft, kPlate] = [0, 1, 2, 3];

function fit(code: string, clearanceUm: number): Fit {
  return {
    code,
    kind: clearanceUm > 0 ? "clearance" : "interference",
    diameter_mm: 10,
    clearance_min_um: clearanceUm - 5,
    clearance_max_um: clearanceUm + 5,
    hole_um: [0, 10],
    shaft_um: [-clearanceUm - 5, -clearanceUm + 5],
    clearance_actual_um: clearanceUm,
    clearance_along_um: [clearanceUm - 6, clearanceUm + 6],
    is_proposed: true,
    reason: "",
  };
}

function mate(id: number, a: number, b: number, more: Partial<Mate> = {}): Mate {
  return {
    id,
    key: `key${id}`,
    kind: "axis_hole",
    a,
    b,
    faces_a: [],
    faces_b: [],
    origin: "inferred",
    p_m: [0, 0, 0],
    axis: [0, 0, 1],
    confidence: 1,
    evidence: "",
    fit: null,
    ...more,
  };
}

const pressed = mate(0, kCover, kBushing, { fit: fit("H7/p6", -20) });
const running = mate(1, kBushing, kShaft, { fit: fit("H7/g6", 15) });
const plane = mate(2, kCover, kPlate, { kind: "face_face" });
const bare = mate(3, kCover, kPlate);
const all = [plane, bare, running, pressed];

describe("the card of a fit", () => {
  it("can be about each axis of a part, and about what two parts share", () => {
    expect(matesWithFit(all, [kBushing])).toEqual([running, pressed]);
    expect(matesWithFit(all, [kShaft, kBushing])).toEqual([running]);
    expect(matesWithFit(all, [kPlate])).toEqual([bare]);
    expect(matesWithFit(all, [])).toEqual([]);
    expect(matesWithFit(all, [kCover, kBushing, kShaft])).toEqual([]);
  });

  it("can be about a tongue in a slot as about a shaft in a hole", () => {
    const slot = mate(4, kCover, kPlate, { kind: "prismatic" });
    expect(matesWithFit([...all, slot], [kPlate])).toEqual([bare, slot]);
  });

  it("begins with the mate that guides, else the tightest, else any", () => {
    expect(firstMate([running, pressed], null)).toBe(pressed);
    expect(firstMate([running, pressed], running.id)).toBe(running);
    expect(firstMate([bare], null)).toBe(bare);
    expect(firstMate([], null)).toBeNull();
  });

  it("stays with the mate that was chosen, whatever its fit becomes, and for these parts only", () => {
    const view = makeViewState();
    chooseCardMate(view, [kBushing], mateKey(pressed));
    const loosened = [running, { ...pressed, id: 7, fit: fit("H7/g6", 40) }];
    const chosen = matesWithFit(loosened, [kBushing]).find((each) => mateKey(each) === chosenCardMate(view, [kBushing]));
    expect(chosen?.a).toBe(kCover);
    expect(chosenCardMate(view, [kShaft])).toBeNull();
    chooseCardMate(view, [kShaft, kBushing], mateKey(running));
    expect(chosenCardMate(view, [kBushing, kShaft])).toBe(mateKey(running));
    expect(chosenCardMate(view, [kBushing])).toBe(mateKey(pressed));
  });

  it("knows what may be a fit", () => {
    for (const text of ["H7/g6", " h11/c11 ", "JS7/h6", "H7/zz99"]) {
      expect(isFitCode(text), text).toBe(true);
    }
    for (const text of ["", "H7", "H7g6", "H7/g", "40 H7/g6", "H7/g6/h6", "H777/g6"]) {
      expect(isFitCode(text), text).toBe(false);
    }
  });
});
