/** How fast pictures follow one another while they have to. */

/** So many in a row that are slow mean a machine without a graphics processor. */
const kSlowMs = 50;
const kSlowCount = 25;
/** So many in a row that are fast mean a machine with one: 30 pictures a second and more. */
const kFastMs = 1000 / 30;
const kFastCount = 20;
/** A longer gap was a pause, or a tab out of sight. */
const kPauseMs = 2000;

export class FrameMeter {
  private last: number | null = null;
  private meanMs = 0;
  private slow = 0;
  private fast = 0;

  /** 0 before anything was measured. */
  get framesPerSecond(): number {
    return this.meanMs === 0 ? 0 : Math.round(1000 / this.meanMs);
  }

  /** Whether pictures have been fast for so long that there is time for more in them. */
  get isFast(): boolean {
    return this.fast >= kFastCount;
  }

  /** @return Whether pictures have been slow for so long that they should be made simpler. */
  drawn(now: number): boolean {
    const ms = this.last === null ? Infinity : now - this.last;
    this.last = now;
    if (ms > kPauseMs) {
      return false;
    }
    this.meanMs = this.meanMs === 0 ? ms : 0.9 * this.meanMs + 0.1 * ms;
    this.slow = ms > kSlowMs ? this.slow + 1 : 0;
    this.fast = ms <= kFastMs ? this.fast + 1 : 0;
    return this.slow >= kSlowCount;
  }

  /** Nothing had to be drawn. */
  rested(): void {
    this.last = null;
    this.slow = 0;
    this.fast = 0;
  }
}
