import { readFileSync } from "node:fs";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { makeCreditFrame, makeInputFrame, splitFrames } from "../src/protocol/decoder";
import { FrameStore } from "../src/protocol/frame_store";
import {
  FrameKind,
  HandInputSize,
  HandStateSize,
  HeaderSize,
  readBodyPose,
  readContactPoint,
  readHandInput,
  readHandState,
  readHeader,
} from "../src/protocol/frames";

function golden(name: string): DataView {
  const bytes = readFileSync(new URL(`golden/${name}.bin`, import.meta.url));
  return new DataView(Uint8Array.from(bytes).buffer);
}

function concat(...views: DataView[]): ArrayBuffer {
  const bytes = new Uint8Array(views.reduce((n, v) => n + v.byteLength, 0));
  let at = 0;
  for (const view of views) {
    bytes.set(new Uint8Array(view.buffer), at);
    at += view.byteLength;
  }
  return bytes.buffer;
}

describe("golden frames, as the server's tests have them", () => {
  it("have a header that reads as it was written", () => {
    const header = readHeader(golden("poses"), 0);
    expect(header).toMatchObject({ kind: FrameKind.Poses, seq: 7, epoch: 3, count: 2, t_ns: 1_234_567_890_123n });
  });

  it("read poses in order: position, then quaternion", () => {
    const pose = readBodyPose(golden("poses"), HeaderSize);
    expect(pose).toEqual({ occurrence: 1, p_WB_m: [1.5, 2, 2.5], q_WB: [3, 3.5, 4, 4.5] });
  });

  it("read both hands", () => {
    const view = golden("hands");
    const first = readHandState(view, HeaderSize);
    const second = readHandState(view, HeaderSize + HandStateSize);
    expect(first.p_WH_m).toEqual([4, 4.5, 5]);
    expect(first.axis_W[2]).toBe(1 + 0.5 * 52);
    expect(second.p_WH_m[0]).toBe(104);
  });

  it("read contacts", () => {
    expect(readContactPoint(golden("contacts"), HeaderSize).f_C_W_n).toEqual([3.5, 4, 4.5]);
  });

  it("are written as the generator writes them", () => {
    const view = golden("input");
    const inputs = [0, 1].map((k) => readHandInput(view, HeaderSize + k * HandInputSize));
    const made = new Uint8Array(makeInputFrame(3, inputs));
    expect(made.slice(HeaderSize)).toEqual(new Uint8Array(view.buffer).slice(HeaderSize));
    expect(readHeader(new DataView(makeCreditFrame(3, 9)), 0)).toMatchObject({ kind: FrameKind.Credit, size: 36 });
  });
});

describe("a message", () => {
  it("passes over kinds that are not known", () => {
    const strange = golden("poses");
    strange.setUint16(6, 99, true);
    const message = concat(strange, golden("contacts"));
    expect(splitFrames(new DataView(message)).map((f) => f.header.kind)).toEqual([99, FrameKind.Contacts]);
  });

  it("ends where it is damaged", () => {
    const cut = golden("hands").buffer.slice(0, 100) as ArrayBuffer;
    expect(splitFrames(new DataView(cut))).toEqual([]);
    const foreign = golden("poses");
    foreign.setUint32(0, 0, true);
    expect(splitFrames(foreign)).toEqual([]);
  });

  it("cannot make anyone read beyond its end by a false count", () => {
    const lying = golden("poses");
    lying.setUint32(20, 1_000_000, true);
    const store = new FrameStore();
    store.ingest(lying.buffer as ArrayBuffer, 0);
    expect(store.poseVersion(1)).toBe(1);
  });
});

describe("the store", () => {
  it("keeps the newest of everything and says what to acknowledge", () => {
    const store = new FrameStore();
    expect(store.ingest(concat(golden("poses"), golden("hands"), golden("contacts")), 5000)).toEqual({ seq: 7, epoch: 3 });
    const pose = new Float32Array(7);
    store.readPose(1, pose);
    expect([...pose]).toEqual([1.5, 2, 2.5, 3, 3.5, 4, 4.5]);
    const live = store.read();
    expect(live?.hands).toHaveLength(2);
    expect(live?.contacts).toHaveLength(2);
    expect(store.sampleCount).toBe(2);
  });

  it("has no contacts when a message brings hands alone", () => {
    const store = new FrameStore();
    store.ingest(concat(golden("hands"), golden("contacts")), 0);
    store.ingest(concat(golden("hands")), 16);
    expect(store.read()?.contacts).toEqual([]);
  });

  it("forgets poses when another scene begins", () => {
    const store = new FrameStore();
    store.ingest(golden("poses").buffer as ArrayBuffer, 0);
    const next = golden("contacts");
    next.setUint32(16, 4, true);
    store.ingest(next.buffer as ArrayBuffer, 1);
    expect(store.poseVersion(1)).toBe(0);
    expect(store.epoch).toBe(4);
  });

  it("is the same through shared memory", () => {
    const writer = FrameStore.makeShared();
    const reader = new FrameStore(writer.buffer);
    writer.ingest(golden("hands").buffer as ArrayBuffer, 0);
    expect(reader.read()?.hands[0]?.hand).toBe(1);
  });
});

describe("the age of what is shown", () => {
  /** When this page's clock began, for the server's [ms]. */
  const kApart = 5e6;
  let now = 0;
  beforeEach(() => {
    now = 1000;
    vi.spyOn(performance, "now").mockImplementation(() => now);
  });
  afterEach(() => vi.restoreAllMocks());

  /** A frame of the server's time, which this page receives so much later. */
  function take(store: FrameStore, serverMs: number, lateMs: number): number {
    const frame = golden("poses");
    frame.setBigInt64(24, BigInt(Math.round(1e6 * serverMs)), true);
    now = kApart + serverMs + lateMs;
    store.ingest(frame.buffer as ArrayBuffer, performance.timeOrigin + now);
    return store.read()?.ageMs ?? NaN;
  }

  /** Frames for so long, 60 a second, each late by 2 to 3 ms; the age after the last. */
  function stream(store: FrameStore, fromMs: number, forMs: number): number {
    let age = 0;
    for (let t = 0; t <= forMs; t += 16) {
      age = take(store, fromMs + t, 2 + (t % 5) / 5);
    }
    return age;
  }

  it("is that of a frame which waited on its way, and of a server that says nothing", () => {
    const store = new FrameStore();
    expect(stream(store, 1000, 2000)).toBeLessThan(2);
    expect(take(store, 3020, 250)).toBeGreaterThan(240);
    now += 700;
    expect(store.read()?.ageMs).toBeGreaterThan(940);
  });

  it("is right at once after a stall of any length", () => {
    for (const stallMs of [100, 900, 1500, 20_000, 3_600_000]) {
      const store = new FrameStore();
      stream(store, 1000, 2000);
      expect(stream(store, 3000 + stallMs, 160), `${stallMs}`).toBeLessThan(3);
    }
  });

  it("is right soon where one of the clocks has stood still meanwhile, or begins anew", () => {
    for (const lostMs of [1500, 60_000, -500_000]) {
      const store = new FrameStore();
      stream(store, 600_000, 2000);
      const before = now;
      const frame = golden("poses");
      for (let k = 0; k < 20; k++) {
        now = before + Math.abs(lostMs) + 16 * k;
        frame.setBigInt64(24, BigInt(Math.round(1e6 * (602_010 + 16 * k + Math.min(0, lostMs)))), true);
        store.ingest(frame.buffer as ArrayBuffer, performance.timeOrigin + now);
      }
      expect(store.read()?.ageMs, `${lostMs}`).toBeLessThan(3);
    }
  });
});
