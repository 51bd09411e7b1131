/** Whether what is drawn has changed so much that one can see it: what rests in a hand trembles by less. */

/** Of positions and lengths [m], and of members of a unit quaternion. */
const kUnseen = 1e-6;

export class Seen {
  private last: readonly number[] = [];

  /** @return Whether it is to be drawn anew. Small changes add up: they are counted from what was drawn last. */
  differs(now: readonly number[]): boolean {
    const { last } = this;
    const isSame = now.length === last.length && now.every((v, k) => Math.abs(v - last[k]!) <= kUnseen);
    if (!isSame) {
      this.last = now;
    }
    return !isSame;
  }
}
