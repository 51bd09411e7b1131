import { describe, expect, it } from "vitest";
import { actions, menus } from "../src/app/actions";

describe("the actions", () => {
  it("have keys of their own: no key does two things", () => {
    const keys = actions.flatMap((a) => a.keys ?? []);
    expect(keys.filter((key, k) => keys.indexOf(key) !== k)).toEqual([]);
  });

  it("have names of their own, and words in every menu", () => {
    const ids = actions.map((a) => a.id);
    expect(new Set(ids).size).toBe(ids.length);
    for (const menu of menus) {
      expect(menu.actions.every((a) => a.label().trim() !== "")).toBe(true);
    }
  });
});
