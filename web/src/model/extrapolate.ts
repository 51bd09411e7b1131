/** Where a thing is now, from where it was when the newest frames were sent. */

import { add, angleBetween, conjugate, multiply, scale, slerp, sub, type Pose, type Vec3 } from "./math";

/** Beyond this a guess is worse than the last known pose. */
const kLongestMs = 50;
/** Frames this far apart say nothing of the present speed. */
const kStaleMs = 120;

interface Known {
  pose: Pose;
  sentMs: number;
}

export class Extrapolator {
  private last: Known | null = null;
  private velocity: Vec3 = [0, 0, 0];
  private turnPerMs: { before: Pose["q"]; after: Pose["q"]; ms: number } | null = null;

  reset(): void {
    this.last = null;
    this.turnPerMs = null;
    this.velocity = [0, 0, 0];
  }

  take(pose: Pose, sentMs: number): void {
    const before = this.last;
    if (before !== null && sentMs <= before.sentMs) {
      return;
    }
    const ms = before === null ? Infinity : sentMs - before.sentMs;
    if (before !== null && ms < kStaleMs) {
      this.velocity = scale(sub(pose.p, before.pose.p), 1 / ms);
      this.turnPerMs = { before: before.pose.q, after: pose.q, ms };
    } else {
      this.velocity = [0, 0, 0];
      this.turnPerMs = null;
    }
    this.last = { pose, sentMs };
  }

  at(nowMs: number): Pose | null {
    if (this.last === null) {
      return null;
    }
    const { pose, sentMs } = this.last;
    const ahead = Math.min(Math.max(0, nowMs - sentMs), kLongestMs);
    const p = add(pose.p, scale(this.velocity, ahead));
    const turn = this.turnPerMs;
    if (turn === null || angleBetween(turn.before, turn.after) < 1e-5) {
      return { p, q: pose.q };
    }
    const step = slerp([1, 0, 0, 0], multiply(turn.after, conjugate(turn.before)), Math.min(1, ahead / turn.ms));
    return { p, q: multiply(step, pose.q) };
  }
}
