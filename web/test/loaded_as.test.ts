import { describe, expect, it } from "vitest";
import { loadedAs } from "../src/view3d/loaded_as";
import type { Scene } from "../src/protocol/messages";

const scene = (name: string, pending: number): Scene => ({ name, source: `${name}.step`, pending }) as unknown as Scene;

describe("loadedAs", () => {
  it("tells products from each other, and their first parts from all", () => {
    expect(loadedAs(scene("pump", 0), null)).toBe("new");
    expect(loadedAs(scene("pump", 3), scene("gear", 3))).toBe("new");
    expect(loadedAs(scene("pump", 0), scene("pump", 3))).toBe("completed");
    expect(loadedAs(scene("pump", 0), scene("pump", 0))).toBe("changed");
    expect(loadedAs(scene("pump", 3), scene("pump", 3))).toBe("changed");
  });
});
