import { describe, expect, it, vi } from "vitest";
import type { Pose, Vec3 } from "../src/model/math";
import { PartPaths, pathCsv, pathLength, pathTurning } from "../src/model/part_path";
import type { Studio } from "../src/model/studio";

const points: Vec3[] = [
  [0, 0, 0],
  [0.3, 0.4, 0],
  [0.3, 0.4, 0.1],
];
const half = Math.SQRT1_2;
const poses: Pose[] = [
  { p: [0, 0, 0], q: [1, 0, 0, 0] },
  { p: [0.3, 0.4, 0], q: [half, 0, 0, half] },
  { p: [0.3, 0.4, 0.1], q: [half, 0, 0, half] },
];
const swept = { glb: "/api/path/1.glb", volume_mm3: 10, error_mm: 0.1 };

function studioThat(answers: (as: string) => unknown): { studio: Studio; asked: string[] } {
  const asked: string[] = [];
  const command = vi.fn(async ({ as }: { as: string }) => {
    asked.push(as);
    return answers(as);
  });
  return { studio: { command } as unknown as Studio, asked };
}

describe("a path", () => {
  it("has the length of its line, and the turning of its poses", () => {
    expect(pathLength(points)).toBeCloseTo(0.6);
    expect(pathTurning(poses)).toBeCloseTo(Math.PI / 2);
    expect(pathLength([])).toBe(0);
  });

  it("is written as a table with a line for each point", () => {
    const lines = pathCsv({ points_m: points, poses, frames_per_pose: 1 }).trim().split("\n");
    expect(lines).toHaveLength(4);
    expect(lines[2]?.split(",").map(Number)).toEqual([0.3, 0.4, 0, 0.3, 0.4, 0, half, 0, 0, half]);
  });

  it("is asked for once in each form, and forgotten for the next part", async () => {
    const { studio, asked } = studioThat((as) => (as === "points" ? { points_m: points, poses, frames_per_pose: 1 } : swept));
    const paths = new PartPaths(studio);
    await paths.show(1, "points");
    await paths.show(1, "swept");
    await paths.show(1, "points");
    expect(asked).toEqual(["points", "swept"]);
    expect(paths.shown.value).toMatchObject({ kind: "points", points: { poses }, swept });
    await paths.show(2, "points");
    expect(asked).toHaveLength(3);
    expect(paths.shown.value?.swept).toBeNull();
  });

  it("is not shown where the server refuses it", async () => {
    const { studio } = studioThat(() => null);
    const paths = new PartPaths(studio);
    await paths.show(1, "swept");
    expect(paths.shown.value).toBeNull();
    expect(paths.isBusy.value).toBe(false);
  });
});
