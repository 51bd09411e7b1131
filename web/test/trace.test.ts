import { describe, expect, it } from "vitest";
import { FrameStore, kSampleSlots, nowMs } from "../src/protocol/frame_store";
import { kKeptS, kTraceFields, LiveTraces, readSeries, Trace } from "../src/model/trace";
import { kPeriodNs, toyFrames } from "./toy_recording";

function sample(fz: number): number[] {
  return kTraceFields.map((field) => (field === "fz_n" ? fz : 0));
}

describe("a trace", () => {
  it("finds its samples by their time, and grows", () => {
    const trace = new Trace();
    for (let k = 0; k < 5000; k++) {
      trace.push(0.01 * k, sample(k));
    }
    expect(trace.count).toBe(5000);
    expect(trace.indexAt(12.345)).toBe(1235);
    expect(readSeries(trace, ["fz_n"], 1, 1.02).columns[0]).toEqual([100, 101, 102]);
  });

  it("forgets only what is too old", () => {
    const trace = new Trace(2);
    for (let k = 0; k < 100_000; k++) {
      trace.push(0.01 * k, sample(k));
    }
    expect(trace.lastS - trace.firstS).toBeGreaterThanOrEqual(2);
    expect(trace.count).toBeLessThan(2048);
    expect(trace.valueAt(trace.count - 1, "fz_n")).toBe(99_999);
  });

  it("leaves out what comes late, and begins anew with another clock", () => {
    const trace = new Trace();
    trace.push(100, sample(1));
    trace.push(99.9, sample(2));
    expect(trace.count).toBe(1);
    trace.push(3, sample(3));
    expect([trace.count, trace.lastS]).toEqual([1, 3]);
  });

  it("is thinned without losing a peak", () => {
    const trace = new Trace();
    for (let k = 0; k < 36_000; k++) {
      trace.push(k / 60, sample(k === 17_771 ? 50 : k === 20_003 ? -30 : Math.sin(k / 500)));
    }
    const { timesS, columns } = readSeries(trace, ["fz_n"], 0, 600, 1000);
    expect(timesS.length).toBeLessThanOrEqual(1002);
    expect(Math.max(...columns[0]!)).toBe(50);
    expect(Math.min(...columns[0]!)).toBe(-30);
    expect(timesS.every((time, k) => k === 0 || time >= timesS[k - 1]!)).toBe(true);
  });
});

describe("the live traces", () => {
  it("take the samples of each hand out of the store, more than its ring holds", () => {
    const store = new FrameStore();
    const traces = new LiveTraces();
    const messages = toyFrames(60);
    const begin = nowMs();
    // The same second over and over, each time later.
    const view = new DataView(messages);
    let sent = 0;
    for (let round = 0; round < 50; round++) {
      for (let at = 0; at < messages.byteLength; ) {
        const size = view.getUint32(at + 8, true);
        const t_ns = view.getBigInt64(at + 24, true);
        const frame = messages.slice(at, at + size);
        const seconds = round * 60 * kPeriodNs;
        new DataView(frame).setBigInt64(24, t_ns + BigInt(seconds), true);
        store.ingest(frame, begin - 60_000 + (Number(t_ns) + seconds) / 1e6);
        at += size;
      }
      sent += 60;
      expect(traces.follow(store)).toBe(true);
    }
    expect(traces.follow(store)).toBe(false);
    expect(sent).toBeGreaterThan(kSampleSlots);
    // A float of the day's seconds tells hundredths of them.
    const trace = traces.of(0);
    expect(trace.count).toBe(sent);
    expect(trace.lastS - trace.firstS).toBeCloseTo(((sent - 1) * kPeriodNs) / 1e9, 1);
    expect(Math.abs(trace.firstS - (begin / 1e3 - 60))).toBeLessThan(0.1);
    expect(kKeptS).toBe(600);
  });
});
