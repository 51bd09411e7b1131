/** How fast pictures follow one another while they have to. */

/** So many in a row that are slow mean a machine without a graphics processor. */
const kSlowMs = 50;
const kSlowCount = 25;
/** A longer gap was a pause, or a tab out of sight. */
const kPauseMs = 2000;

export class FrameMeter {
  private last: number | null = null;
  private meanMs = 0;
  private slow = 0;

  /** 0 before anything was measured. */
  get framesPerSecond(): number {
    return this.meanMs === 0 ? 0 : Math.round(1000 / this.meanMs);
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
    return this.slow >= kSlowCount;
  }

  /** Nothing had to be drawn. */
  rested(): void {
    this.last = null;
    this.slow = 0;
  }
}
