import { describe, expect, it } from "vitest";
import { kSilentMs, SilenceWatch } from "../src/protocol/silence";

/** What is done in a stretch of time in which nothing is heard, looked at every 50 ms. */
function pass(watch: SilenceWatch, from: number, to: number): { at: number; does: string }[] {
  const done = [];
  for (let now = from; now <= to; now += 50) {
    const does = watch.look(now);
    if (does !== null) {
      done.push({ at: now - from, does });
    }
  }
  return done;
}

describe("the watch over the server", () => {
  it("asks a server that is quiet, and says after a second that it is silent, once", () => {
    const watch = new SilenceWatch();
    watch.hear(0);
    expect(pass(watch, 0, 10_000)).toEqual([
      { at: 500, does: "ask" },
      { at: kSilentMs, does: "tell" },
    ]);
    expect(watch.hear(10_000)).toBe(true);
    expect(watch.hear(10_010)).toBe(false);
  });

  it("has nothing to say of one that answers, or speaks by itself", () => {
    const watch = new SilenceWatch();
    watch.hear(0);
    for (let now = 0; now < 20_000; now += 50) {
      const does = watch.look(now);
      expect(does).not.toBe("tell");
      if (does === "ask") {
        watch.hear(now + 100);
      }
    }
  });

  it("does not blame the server where the page itself stood still", () => {
    const watch = new SilenceWatch();
    watch.hear(0);
    // Nobody has looked for a minute; what was said meanwhile is heard after the first look.
    expect(watch.look(60_000)).toBe("ask");
    expect(watch.look(60_050)).toBeNull();
    expect(watch.hear(60_060)).toBe(false);
  });

  it("expects nothing before the first word, nor after the connection ended", () => {
    const watch = new SilenceWatch();
    expect(pass(watch, 0, 5000)).toEqual([]);
    watch.hear(5000);
    watch.stop();
    expect(pass(watch, 5000, 10_000)).toEqual([]);
  });
});
