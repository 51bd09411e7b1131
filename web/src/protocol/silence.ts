/** Notices that the server says nothing any more, though the connection is there. Times are in ms, on any clock. */

/** How long the other side may be silent until it is asked for a word. */
const kQuietMs = 500;
/** After so long it is silent. */
export const kSilentMs = 1000;
/** An answer may take that long: a page that itself stood still hears later what was said meanwhile. */
const kAnswerMs = 300;

export class SilenceWatch {
  private heardAt: number | null = null;
  private askedAt: number | null = null;
  private isSilent = false;

  /** A word came. @return Whether it ends a silence. */
  hear(now: number): boolean {
    const wasSilent = this.isSilent;
    this.heardAt = now;
    this.askedAt = null;
    this.isSilent = false;
    return wasSilent;
  }

  /** The connection ended: nothing is expected until the first word of the next one. @return As of hear. */
  stop(): boolean {
    const wasSilent = this.hear(0);
    this.heardAt = null;
    return wasSilent;
  }

  /** What is to be done now; to be called many times a second. */
  look(now: number): "ask" | "tell" | null {
    if (this.heardAt === null || this.isSilent) {
      return null;
    }
    if (this.askedAt === null) {
      if (now - this.heardAt < kQuietMs) {
        return null;
      }
      this.askedAt = now;
      return "ask";
    }
    this.isSilent = now - this.heardAt >= kSilentMs && now - this.askedAt >= kAnswerMs;
    return this.isSilent ? "tell" : null;
  }
}
