/** The way that a part has gone or has to go: as points and poses, or as the room that it sweeps (X13). */

import { signal } from "@preact/signals";
import type { PathPoints, PathSwept } from "../protocol/messages";
import { csvText } from "./csv";
import { angleBetween, distance, type Pose, type Vec3 } from "./math";
import type { Studio } from "./studio";

export type PathKind = "points" | "swept";

export interface ShownPath {
  occurrence: number;
  kind: PathKind;
  points: PathPoints | null;
  swept: PathSwept | null;
}

export class PartPaths {
  /** What is shown, or asked for. */
  readonly shown = signal<ShownPath | null>(null);
  readonly isBusy = signal(false);

  constructor(private readonly studio: Studio) {}

  /** The swept volume takes the server some seconds. */
  async show(occurrence: number, kind: PathKind): Promise<void> {
    const before = this.shown.value?.occurrence === occurrence ? this.shown.value : null;
    const wanted: ShownPath = { points: null, swept: null, ...before, occurrence, kind };
    this.shown.value = wanted;
    if ((kind === "points" ? wanted.points : wanted.swept) !== null) {
      return;
    }
    this.isBusy.value = true;
    const answer =
      kind === "points"
        ? await this.studio.command({ command: "path", occurrence, as: "points" })
        : await this.studio.command({ command: "path", occurrence, as: "swept" });
    this.isBusy.value = false;
    if (this.shown.value?.occurrence !== occurrence) {
      // Something else is asked for meanwhile.
      return;
    }
    if (answer === null) {
      this.shown.value = before;
    } else {
      this.shown.value = { ...this.shown.value, ...("glb" in answer ? { swept: answer } : { points: answer }) };
    }
  }

  hide(): void {
    this.shown.value = null;
  }
}

/** Of a line through points [m]. */
export function pathLength(points: readonly Vec3[]): number {
  return points.reduce((sum, p, k) => sum + (k === 0 ? 0 : distance(p, points[k - 1]!)), 0);
}

/** All turning along the way [rad]. */
export function pathTurning(poses: readonly Pose[]): number {
  return poses.reduce((sum, { q }, k) => sum + (k === 0 ? 0 : angleBetween(q, poses[k - 1]!.q)), 0);
}

/** A line for each pose: position [m] and quaternion in W. */
export function pathCsv({ points_m, poses }: PathPoints): string {
  const rows = points_m.map((p, k) => {
    const pose = poses[k];
    return [...p, ...(pose === undefined ? ["", "", "", "", "", "", ""] : [...pose.p, ...pose.q])];
  });
  return csvText([["x_m", "y_m", "z_m", "part_x_m", "part_y_m", "part_z_m", "q_w", "q_x", "q_y", "q_z"], ...rows]);
}
